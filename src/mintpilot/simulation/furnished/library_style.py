"""One more style: the reading room of an old library, panelled in the wood that its doors are made of.

Written from the place alone, and committed before any picture of it was perceived.
"""

from __future__ import annotations

from mintpilot.simulation.furnished.style import Style

LIBRARY = Style(
    name="library",
    floor=((0.46, 0.33, 0.20), (0.38, 0.27, 0.16)),
    floor_tile_m=0.3,
    walls=((0.78, 0.72, 0.58), (0.75, 0.69, 0.55)),
    wall_tile_m=1.6,
    ceiling=(0.90, 0.87, 0.80),
    light=(0.95, 0.82, 0.60),
    ambient=0.40,
    lamps=((0.3, 0.5, 2.5), (0.7, 0.5, 2.5), (0.5, 0.2, 1.5)),
    room_m=((7.0, 10.0), (5.2, 6.8)),
    doors=((0.44, 0.29, 0.17), (0.50, 0.34, 0.21), (0.28, 0.17, 0.10), (0.16, 0.28, 0.20)),
    relief_m=(0.0, 0.09),
    door_m=((0.78, 1.05), (2.0, 2.2)),
    framed=True,
    door_forms=("panelled", "double", "plain", "ajar", "glazed"),
    fittings=("panelling", "carpet", "pictures"),
    cloth=((0.44, 0.29, 0.17), (0.50, 0.34, 0.21), (0.35, 0.12, 0.12), (0.14, 0.24, 0.20)),
    clothes=(
        (0.32, 0.30, 0.26),
        (0.55, 0.48, 0.36),
        (0.16, 0.20, 0.30),
        (0.46, 0.14, 0.18),
        (0.80, 0.78, 0.72),
        (0.26, 0.36, 0.28),
    ),
    skin=((0.93, 0.76, 0.66), (0.76, 0.55, 0.42), (0.52, 0.34, 0.24), (0.28, 0.18, 0.13)),
    hair=((0.10, 0.08, 0.06), (0.40, 0.26, 0.14), (0.70, 0.70, 0.70)),
    wear=("", "scarf", "coat", "long hair", "pack"),
    long_sleeves=True,
    stature=(1.50, 1.92),
    girth=(0.85, 1.25),
    round_limbs=True,
    postures=(
        "sitting",
        "standing",
        "reaching",
        "bending",
        "kneeling",
        "slumped",
        "covered",
        "curled",
        "child",
        "child crawling",
        "child cross-legged",
    ),
    lying_on=("sofa",),
    people=(1, 5),
    table_m=((1.2, 2.2), (0.7, 1.0), (0.70, 0.78)),
    round_tables=False,
    wood=((0.40, 0.26, 0.15), (0.30, 0.19, 0.11), (0.55, 0.40, 0.24)),
    clutter=("books", "lamp", "laptop", "backpack", "plant", "mug", "bottle", "shoes", "ball", "bin", "bag"),
    furniture=("shelf", "sofa", "armchair", "floor lamp", "chair", "ladder", "cabinet", "trolley", "coats"),
    pieces=(2, 5),
    things=(1, 5),
    eye_m=(1.2, 1.9),
)
