"""How much each measure of a lump speaks for somebody in it: log odds, by logistic regression on tuned styles.

`python -m bench.perception_weights` finds such weights anew.
Found on 100 rooms, seeds 6000 to 6019 of each tuned style, all segments of eight views each, and on the real tabletop
frames that parameters were chosen on, in which nobody is; frozen.
"""

from __future__ import annotations

BIAS = -1.4230
WEIGHTS = (
    ("height", 0.7661),
    ("height²", -0.0589),
    ("length", -0.6186),
    ("length²", 1.6002),
    ("breadth", 0.6715),
    ("breadth²", -4.4009),
    ("length x height", -1.7154),
    ("flat", -13.4345),
    ("boxlike", -0.0210),
    ("round", -2.8744),
    ("turned", -23.5287),
    ("solid", -0.9544),
    ("uneven top", 4.2524),
    ("level top", -2.6402),
    ("middle height", 0.0116),
    ("foot", -7.7131),
    ("cut", 0.3146),
    ("pixels", 3.0700),
    ("on floor", 3.7646),
    ("hanging", -0.1584),
    ("taper", 0.1928),
    ("gaps", -0.3951),
    ("bed", -0.2147),
    ("bed with uneven top", 2.0495),
    ("like a person", 3.9765),
)
