"""The link released against dry friction: exact from turn to turn, at rest where friction holds it.

While the link moves one way, friction is a constant torque against it (Coulomb), and the motion is linear; each turn is
found, as is the moment a block is left or met. Where the torque at a turn is no more than the friction the link
sticks. The polymer goes on relaxing and may drive it on; a link that creeps so slowly that it would slip and stick at
every period of the joint is followed without its inertia.
Source: J. P. Den Hartog, Mechanical Vibrations, 4th ed.: free vibration with Coulomb damping.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tvimdesign.physics.motions import motion, one_sided
from tvimdesign.physics.motions.motion import Joint, Modes
from tvimdesign.physics.motions.one_sided import Blocks, Touching
from tvimdesign.simulation.link_motion import link
from tvimdesign.simulation.link_motion.contact_simulation import (
    NUDGE,
    SEARCHED,
    ContactEvent,
    OneSided,
    Regime,
    stretches_of,
    turns_of,
)
from tvimdesign.simulation.link_motion.link import Array, Motion

NEGLECTED = 1e-5
"""Share of the first angle by which a link that has come loose may swing about where the polymer drives it, and is
then followed without its inertia."""
HELD = Touching(1.0, 1.0)


class Sliding(Enum):
    """What friction does to the link."""

    FORWARD = 1.0
    BACKWARD = -1.0
    STUCK = 0.0
    CREEPING_FORWARD = 2.0
    CREEPING_BACKWARD = -2.0

    @property
    def sign(self) -> float:
        """Sense in which the link moves, or 0."""
        return float(np.sign(self.value))

    @property
    def creeping(self) -> bool:
        """Whether the link follows the polymer without inertia."""
        return abs(self.value) > 1.0


class Phase(NamedTuple):
    """What makes the motion linear: the blocks that touch, and the sense of sliding."""

    touching: Touching
    sliding: Sliding


@dataclass(frozen=True)
class Plant:
    """A link on its springs and its polymer: a layer that is bonded, or blocks that only push."""

    joint: Joint
    modes: Modes
    one_sided: bool

    @cached_property
    def blocks(self) -> Blocks:
        """The blocks on either side, which are alike."""
        return Blocks(self.modes, self.modes)

    @property
    def size(self) -> int:
        """Count of states: angle, speed, internal angles."""
        return 2 + len(self.modes) * (2 if self.one_sided else 1)

    def stiffness(self, period: float) -> float:
        """Stiffness [N*m/rad] of springs and of what of the polymer does not relax within a period [s]."""
        layer = sum(stiffness for time, stiffness in self.modes if time > period)
        support = self.joint.structure_stiffness
        return float(self.joint.spring_stiffness + support * layer / (support + layer))

    def torque(self, angle: Array, inner: list[Array], touching: Touching) -> Array:
        """Torque of springs and polymer on the link [N*m], friction not counted."""
        if self.one_sided:
            return np.asarray(one_sided.module_torque(angle, inner, touching, self.joint, self.blocks))
        return np.asarray(motion.module_torque(angle, inner, self.joint, self.modes))

    def internal_rates(self, angle: Array, inner: list[Array], touching: Touching) -> Array:
        """Rates of the internal angles [rad/s], one row each."""
        if self.one_sided:
            return np.array(one_sided.internal_rates(angle, inner, touching, self.joint, self.blocks))
        return np.array(motion.internal_rates(angle, inner, self.joint, self.modes))

    def energy(self, angle: Array, speed: Array, inner: list[Array], touching: Touching) -> Array:
        """Stored energy [J]."""
        if self.one_sided:
            return np.asarray(one_sided.stored_energy(angle, speed, inner, touching, self.joint, self.blocks))
        return np.asarray(motion.stored_energy(angle, speed, inner, self.joint, self.modes))

    def to_energy(self) -> Array:
        """Coordinates whose square is twice the energy with all in contact."""
        identity = np.eye(self.size)
        parts = (identity[0], identity[1], list(identity[2:]))
        if self.one_sided:
            terms = one_sided.energy_terms(*parts, HELD, self.joint, self.blocks)
        else:
            terms = motion.energy_terms(*parts, self.joint, self.modes)
        return np.asarray(np.linalg.qr(np.array([np.sqrt(c) * d for c, d in terms]), mode="r"))

    def pulls(self) -> Array:
        """Rows that take the state to the blocks' pulls; none where the layer is bonded."""
        identity = np.eye(self.size)
        if not self.one_sided:
            return np.empty((0, self.size))
        return np.array(one_sided.pulls(identity[0], list(identity[2:]), self.blocks))


def released(plant: Plant, friction: float, angle: float, internal: Array, turns: float = np.inf) -> OneSided:
    """Let go of a link at rest against a friction torque [N*m], and follow it until it stays, or for an hour.

    With `turns` not much longer than until it has turned round so often.
    """
    course = FrictionCourse(plant, friction)
    course.start(angle, internal)
    enough = link.DEAD**2 * course.branch_energy()
    first = course.quickest / link.SAMPLES_A_PERIOD
    while not course.over(enough, turns):
        course.follow(first, enough, turns)
    return course.found()


class FrictionCourse:
    """A motion against friction on its way: where it is, its phase, and what it has come through."""

    def __init__(self, plant: Plant, friction: float) -> None:
        """Take the link and the torque that resists it [N*m]; `start` comes next."""
        self._plant, self._friction = plant, friction
        self._to = np.zeros((plant.size + 1, plant.size + 1))
        self._to[:-1, :-1], self._to[-1, -1] = plant.to_energy(), 1.0
        self._from = np.linalg.inv(self._to)
        self._pulls = plant.pulls()
        self._regimes: dict[Phase, Regime] = {}
        self._switched: set[int] = set()
        self.quickest = 2.0 * np.pi * np.sqrt(plant.joint.inertia / plant.stiffness(0.0))
        """Period of the joint before any mode relaxes [s]."""
        self._swing = plant.stiffness(self.quickest)
        self._swing *= np.sqrt(self._swing / plant.joint.inertia)
        self._least = 0.0
        self.events: list[ContactEvent] = []

    def start(self, angle: float, internal: Array) -> None:
        """Begin at rest; the link slides at once where its torque is more than the friction."""
        state = np.concatenate([[angle, 0.0], internal, [1.0]])
        touching = HELD
        if len(self._pulls):
            touching = Touching(*((self._pulls @ state[:-1]) > 0.0).astype(float).tolist())
        self._least = NEGLECTED * abs(angle)
        self.columns, self.durations, self.time = [self._to @ state], list[float](), 0.0
        self.phase = Phase(touching, self._after_a_stop(state, touching))
        self.phases = [self.phase]

    def follow(self, first: float, enough: float, turns: float) -> None:
        """Go on with steps that grow until a block is left or met, the link sticks or comes loose, or all is over."""
        contacts, held = len(self.events), self.phase.sliding.sign == 0.0 or self.phase.sliding.creeping
        values = np.zeros(1) if held else self._regime(self.phase).values
        for step, count in link.growing(first, values):
            for _ in range(count):
                self._across(step)
                now_held = self.phase.sliding.sign == 0.0 or self.phase.sliding.creeping
                if len(self.events) > contacts or now_held != held:
                    return
            if self.over(enough, turns):
                return

    def over(self, enough: float, turns: float) -> bool:
        """Whether the link stays where it is, too long was looked at it, or it has turned round often enough."""
        if self.time >= link.LONGEST or len(self.columns) >= link.MOST_SAMPLES:
            return True
        if np.isfinite(turns) and len(turns_of(self._from[1] @ np.column_stack(self.columns))) >= turns:
            return True
        return self._spent() or (self.phase.sliding is Sliding.STUCK and self.branch_energy() <= enough)

    def _spent(self) -> bool:
        """Whether a link that creeps has nothing left that drives it: it does so as long as rounding lets it."""
        return self.phase.sliding.creeping and self.branch_energy() <= 0.0

    def branch_energy(self) -> float:
        """Energy that is not in the springs [J]: what may still drive the link on."""
        angle, speed, *inner = (self._from @ self.columns[-1])[:-1]
        whole = float(self._plant.energy(angle, speed, inner, self.phase.touching))
        return whole - float(0.5 * self._plant.joint.spring_stiffness * angle**2)

    def found(self) -> OneSided:
        """All it has come through; the torque is that on the link, friction counted."""
        states = (self._from @ np.column_stack(self.columns))[:-1]
        touching = Touching(*np.array([phase.touching for phase in self.phases]).T)
        inner = list(states[2:])
        pushed = self._plant.torque(states[0], inner, touching)
        sign = np.array([phase.sliding.sign for phase in self.phases])
        moved = Motion(
            times=np.concatenate([[0.0], np.cumsum(self.durations)]),
            angle=states[0],
            speed=states[1],
            internal=states[2:],
            torque=np.where(sign == 0.0, 0.0, pushed - sign * self._friction),
            energy=self._plant.energy(states[0], states[1], inner, touching),
            stretches=stretches_of(self.durations),
        )
        rest = float(states[0, -1]) if self.phase.sliding is Sliding.STUCK or self._spent() else None
        return OneSided(moved, np.array(touching) > 0.0, tuple(self.events), rest)

    def _across(self, step: float) -> None:
        """Go on by a step [s], through the events in it."""
        left = step
        while left > SEARCHED * step:
            state, regime = self.columns[-1], self._regime(self.phase)
            end = regime.after(state, left) if left == step else regime.later(state, left)
            ways = ((regime.leaving(guard, state, end, left), guard) for guard in range(len(regime.pulls)))
            leaving = [(time, guard) for time, guard in ways if time is not None]
            if not leaving:
                self._go(left, end)
                return
            time, guard = min(leaving)
            if time <= SEARCHED * step and guard in self._switched:
                time = min(NUDGE * step, left)
                self._go(time, regime.later(state, time))
            else:
                if time > 0.0:
                    self._go(time, regime.later(state, time))
                self._switch(guard)
            left -= time

    def _go(self, time: float, state: Array) -> None:
        self.columns.append(state)
        self.durations.append(time)
        self.phases.append(self.phase)
        self.time += time
        self._switched.clear()

    def _switch(self, guard: int) -> None:
        """Enter the phase that follows where a guard has come to zero: a contact's, or friction's."""
        touching, sliding = self.phase
        if guard < len(self._pulls):
            sides = list(touching)
            sides[guard] = 1.0 - sides[guard]
            self.events.append(ContactEvent(self.time, guard, sides[guard] > 0.0))
            self.phase = Phase(Touching(*sides), sliding)
        else:
            state = self._from @ self.columns[-1]
            state[1] = 0.0
            self.columns[-1] = self._to @ state
            self.phase = Phase(touching, self._next(sliding, state, touching))
        self.phases[-1] = self.phase
        self._switched.add(guard)

    def _next(self, sliding: Sliding, state: Array, touching: Touching) -> Sliding:
        """What friction does next to a link that has stopped, or that has come loose."""
        if sliding.creeping:
            return Sliding.STUCK
        if sliding is not Sliding.STUCK:
            return self._after_a_stop(state, touching)
        inner = list(state[2:-1])
        pushed = float(self._plant.torque(state[0], inner, touching))
        # A torque that grows at the rate r makes a link swing by r/(K omega) about where it would be without inertia.
        relaxing = list(self._plant.internal_rates(state[0], inner, touching))
        growing = abs(float(self._plant.torque(np.array(0.0), relaxing, touching)))
        return Sliding(float(np.sign(pushed)) * (2.0 if growing < self._swing * self._least else 1.0))

    def _after_a_stop(self, state: Array, touching: Touching) -> Sliding:
        """Whether friction holds a link at rest, or which way it goes."""
        pushed = float(self._plant.torque(state[0], list(state[2:-1]), touching))
        return Sliding.STUCK if abs(pushed) <= self._friction else Sliding(float(np.sign(pushed)))

    def _regime(self, phase: Phase) -> Regime:
        """The linear motion of a phase with a constant for the friction's torque; its guards stay above zero."""
        if phase not in self._regimes:
            size = self._plant.size
            rows = np.eye(size, size + 1)
            one = np.eye(1, size + 1, size)[0]
            inner = list(rows[2:])
            pushed = self._plant.torque(rows[0], inner, phase.touching)
            relaxing = self._plant.internal_rates(rows[0], inner, phase.touching)
            sign, inertia = phase.sliding.sign, self._plant.joint.inertia
            matrix = np.zeros((size + 1, size + 1))
            matrix[2:size] = relaxing
            if phase.sliding is Sliding.STUCK:
                guards = [self._friction * one - pushed, self._friction * one + pushed]
            elif phase.sliding.creeping:
                # The torque stays that of the friction: what the internal angles take of it the angle gives.
                matrix[0] = -(pushed[2:size] @ relaxing) / pushed[0]
                guards = [sign * matrix[0]]
            else:
                matrix[0] = rows[1]
                matrix[1] = (pushed - sign * self._friction * one) / inertia
                guards = [sign * rows[1]]
            signs = 2.0 * np.array(phase.touching) - 1.0
            contacts = [side * np.append(pull, 0.0) for side, pull in zip(signs, self._pulls, strict=False)]
            held = np.array([*contacts, *guards]) @ self._from
            self._regimes[phase] = Regime([1.0] * len(held), self._to @ matrix @ self._from, held)
        return self._regimes[phase]
