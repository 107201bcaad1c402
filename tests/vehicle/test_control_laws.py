"""Laws of the link's control under random faults, commands, delays and silences of the loop."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mintpilot.conformance.faults.link_trial import (
    COMMANDS,
    FAULTS,
    FLIGHT_S,
    MOST_HAPPENINGS,
    PLACES,
    Happening,
    LinkFlight,
)
from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.vehicle.course import SetPoint
from mintpilot.vehicle.signals import Act, Action

times = st.floats(0.0, FLIGHT_S).map(lambda t: round(t, 2))
happenings = st.lists(
    st.builds(Happening, at_s=times, what=st.sampled_from([*FAULTS, Fault.PILOT, Fault.SILENCE, *COMMANDS, *PLACES])),
    min_size=1,
    max_size=MOST_HAPPENINGS,
).map(lambda items: sorted(items, key=lambda item: item.at_s))


def check_laws(flavour, happened, landable, returns):
    flight = LinkFlight(flavour=flavour, landable=landable, returns=returns)
    flight.fly(happened)
    assert list(flight.breaches()) == []


worlds = {
    "flavour": st.sampled_from(list(Flavour)),
    "happened": happenings,
    "landable": st.sampled_from([True, False, "west"]),
    "returns": st.booleans(),
}


@pytest.mark.long
@settings(max_examples=30, deadline=None, suppress_health_check=list(HealthCheck))
@given(**worlds)
def test_no_fault_makes_it_do_what_is_unsafe(flavour, happened, landable, returns):
    check_laws(flavour, happened, landable, returns)


@pytest.mark.slow
@settings(max_examples=1000, deadline=None, suppress_health_check=list(HealthCheck))
@given(**worlds)
def test_no_fault_makes_it_do_what_is_unsafe_a_thousand_times(flavour, happened, landable, returns):
    check_laws(flavour, happened, landable, returns)


@pytest.mark.parametrize(
    ("order", "rule"),
    [
        (SetPoint(position_m=(20.0, 0.0, 1.0)), "set-point"),
        (SetPoint(position_m=(2.0, 2.0, 1.0), velocity_mps=(9.0, 0.0, 0.0)), "set-point"),
        (Act(action=Action.RETURN), "return"),
        (Act(action=Action.LAND), "landing"),
    ],
)
def test_an_order_that_must_not_be_given_is_found(order, rule):
    flight = LinkFlight(flavour=Flavour.PX4, landable=False, returns=False)
    flight.rig.given.append((1.0, order))
    assert rule in {breach.rule for breach in flight.breaches()}
