"""How much each piece of evidence speaks for a door: log odds, by logistic regression on rooms of the tuned styles.

`python -m bench.perception_weights` finds such weights anew.
Found on 200 rooms, seeds 5000 to 5015 and 6000 to 6023 of each tuned style, all
frames of eight views each; frozen.
"""

from __future__ import annotations

BIAS = -10.888
WEIGHTS = (
    ("jambs, mean", 3.116),
    ("jambs, weaker", -1.532),
    ("jambs near the floor", 1.910),
    ("lintel", 1.002),
    ("lintel in view", -1.037),
    ("lintel goes on", -3.657),
    ("jambs go on above", -1.963),
    ("colour against the wall", 5.017),
    ("relief against the wall", 3.094),
    ("sides differ in colour", -2.917),
    ("wall beside", 2.939),
    ("inside in view", -0.200),
    ("inside uneven", -1.096),
    ("pixels", 0.923),
    ("narrow", -8.412),
    ("wide", -2.412),
    ("height", -12.148),
    ("level lines inside", -8.727),
    ("upright lines inside", 1.987),
    ("lintel x jambs", 4.391),
    ("wall above differs", 0.823),
)
