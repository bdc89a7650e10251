"""Function block for jogging."""

from __future__ import annotations

from typing import Any

from takt.axis import Axis
from takt.feedback import Feedback
from takt.plcopen.base import FunctionBlock, Input


class GT_Jog(FunctionBlock):  # noqa: N801
    """Moves as long as JogPos or JogNeg is true and Enable is true. The direction pressed first wins; both must be
    released before the next jog, so a key that is held while Enable becomes true has no effect. Velocities and ramps
    take effect when a key is pressed or released; a jog that cannot continue with them ends."""

    Enable = Input(False)
    JogPos = Input(False)
    JogNeg = Input(False)
    JogVelo = Input[float | None](None, "velocity")
    JogAcc = Input[float | None](None, "acceleration")
    JogDec = Input[float | None](None, "deceleration")
    JogJerk = Input[float | None](None, "jerk")

    def __init__(self, axis: Axis, **inputs: Any) -> None:
        self._keys = (False, False)  # in effect in the previous call
        self._up = True  # both keys were released in the previous call, whether Enable was true or not
        self._feedback: Feedback | None = None
        self._changed: list[Feedback] = []  # earlier jogs, which end when the last one is accepted
        self._seen = True  # the error of the last jog was shown, if it has one
        super().__init__(axis, **inputs)

    def _scan(self) -> None:
        pressed = (bool(self.JogPos), bool(self.JogNeg))
        keys = pressed if self.Enable else (False, False)
        if keys != self._keys:
            self._press(keys)
        self._keys = keys
        self._up = not any(pressed)
        failed = self._feedback is not None and self._feedback.error
        if failed or not any(keys):
            self._release()
        if self._feedback is not None and failed and (any(keys) or not self._seen):
            self._show_error(self._feedback.error_id, self._feedback.sentence)
            self._seen = True

    def _press(self, keys: tuple[bool, bool]) -> None:
        jogs = self._feedback is not None and self._feedback.busy and not self._feedback.released
        if not any(keys) or not (jogs or self._up):
            return
        if self._feedback is not None:
            self._changed = [f for f in (*self._changed, self._feedback) if f.busy]
        self._feedback = self.Axis.jog(forward=keys[0], backward=keys[1], **self._arguments())
        self._seen = False

    def _release(self) -> None:
        for jog in (*self._changed, self._feedback):
            if jog is not None and jog.busy and not jog.released:
                jog.release()


class MC_Jog(GT_Jog):  # noqa: N801
    """GT_Jog under PLCopen's name."""
