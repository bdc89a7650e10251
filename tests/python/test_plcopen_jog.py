"""GT_Jog: moving by hand (AX-39)."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import takt
from machines import MACHINE
from takt import plcopen as plc


@pytest.fixture
def engine() -> Iterator[takt.Engine]:
    with takt.Engine(MACHINE) as made:
        made.axis("x").power().wait()
        yield made


@pytest.fixture
def x(engine: takt.Engine) -> takt.Axis:
    return engine.axis("x")


def test_jog(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-39: the direction pressed first wins; both must be let go before the next jog."""
    jog = plc.GT_Jog(x, JogVelo=50.0)
    jog(JogPos=True)
    engine.step(50)
    assert x.set_velocity == 0  # not enabled
    jog(JogPos=False)
    for press in ({"Enable": True, "JogPos": True}, {"JogNeg": True}):
        jog(**press)
        engine.step(200)
        assert x.set_velocity == pytest.approx(50.0)
    jog(JogPos=False)
    engine.step(300)
    assert x.set_velocity == 0
    jog(JogNeg=False)
    engine.step(5)
    jog(JogNeg=True)
    engine.step(200)
    assert x.set_velocity == pytest.approx(-50.0)
    jog(Enable=False)
    engine.step(300)
    assert x.set_velocity == 0
    assert not jog.Error


def test_a_jog_needs_a_key_pressed_anew(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-39: a key that is held while Enable goes and comes moves nothing; nor does one pressed before Enable."""
    jog = plc.GT_Jog(x, JogVelo=50.0)
    jog(Enable=True, JogPos=True)
    engine.step(100)
    assert x.set_velocity == pytest.approx(50.0)
    for change in ({"Enable": False}, {"Enable": True}, {"JogNeg": True}, {"JogPos": False}):
        jog(**change)
        engine.step(200)
        assert x.set_velocity == 0
    jog(Enable=False, JogNeg=False)  # seen up while not enabled
    jog(JogPos=True)
    jog(Enable=True)
    engine.step(100)
    assert x.set_velocity == 0
    jog(JogPos=False)
    jog(JogPos=True)
    engine.step(100)
    assert x.set_velocity == pytest.approx(50.0)


def test_a_jog_that_cannot_go_on(engine: takt.Engine, x: takt.Axis) -> None:
    """AX-39: the second key brings a velocity that is refused; the axis does not run on without anyone holding it."""
    jog = plc.GT_Jog(x, Enable=True, JogVelo=50.0)
    jog(JogPos=True)
    engine.step(100)
    assert (jog(JogNeg=True, JogVelo=-1.0).Error, jog.ErrorID) == (True, 5)
    engine.step(200)
    assert x.set_velocity == 0
    assert jog().Error
    assert not jog(JogPos=False, JogNeg=False).Error


def test_the_error_of_a_short_jog_is_seen(engine: takt.Engine) -> None:
    """AX-11: the key is let go before the answer is there; the error is shown in one call."""
    jog = plc.GT_Jog(engine.axis("r"), Enable=True)  # not powered
    jog(JogPos=True)
    jog(JogPos=False)
    engine.step()
    assert (jog().Error, jog.ErrorID) == (True, 10)
    assert not jog().Error


def test_a_jog_that_is_refused(engine: takt.Engine) -> None:
    """AX-39: the error stays until the keys are let go."""
    jog = plc.GT_Jog(engine.axis("r"), Enable=True)  # not powered
    jog(JogPos=True)
    engine.step(2)
    assert (jog().Error, jog.ErrorID) == (True, 10)
    engine.axis("r").power().wait()
    assert jog(JogNeg=True).Error
    engine.step(50)
    assert engine.axis("r").set_velocity == 0
    jog(JogPos=False)
    assert not jog(JogNeg=False).Error
    jog(JogNeg=True)
    engine.step(50)
    assert engine.axis("r").set_velocity < 0
