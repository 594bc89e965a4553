"""The link's motion on its way: exact from event to event, every event found.

As long as the same blocks touch and friction acts the same way, the motion is linear and the matrix exponential carries
it. Each step is searched for the moment at which a block is left or met, or at which the link stops or comes loose.

While the link moves one way, friction is a constant torque against it (Coulomb). Where the torque at a turn is no more
than the friction the link sticks. The polymer goes on relaxing and may drive it on; a link that creeps so slowly that
it would slip and stick at every period of the joint is followed without its inertia.
Source: J. P. Den Hartog, Mechanical Vibrations, 4th ed.: free vibration with Coulomb damping.
"""

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tvimdesign.physics.motions import motion, one_sided
from tvimdesign.physics.motions.motion import Joint, Modes
from tvimdesign.physics.motions.one_sided import Blocks, Touching
from tvimdesign.simulation.link_motion import sampled_motion
from tvimdesign.simulation.link_motion.sampled_motion import Array, ContactEvent, Motion, OneSided

SEARCHED = 1e-13  # Share of a step to which an event is located
NUDGE = 2.0**-10  # Share of a step taken where a block is grazed, before it is asked again whether it touches
NEGLECTED = 1e-5
"""Share of the first angle by which a link that has come loose may swing about where the polymer drives it, and is
then followed without its inertia."""
HELD = Touching(1.0, 1.0)


class Sliding(Enum):
    """The way a link moves: free, turned as prescribed, or against friction; with the sense of the sliding, or 0."""

    FREE = ("free", 0.0)
    PRESCRIBED = ("prescribed", 0.0)
    STUCK = ("stuck", 0.0)
    FORWARD = ("sliding", 1.0)
    BACKWARD = ("sliding", -1.0)
    CREEPING_FORWARD = ("creeping", 1.0)
    CREEPING_BACKWARD = ("creeping", -1.0)

    @property
    def sign(self) -> float:
        """Sense in which the link slides, or 0."""
        return float(self.value[1])

    @property
    def creeping(self) -> bool:
        """True where the link follows the polymer without inertia."""
        return self in {Sliding.CREEPING_FORWARD, Sliding.CREEPING_BACKWARD}

    @property
    def swings(self) -> bool:
        """True where the link's inertia takes part."""
        return self is not Sliding.STUCK and not self.creeping


class Phase(NamedTuple):
    """The two things that keep the motion linear: the blocks that touch, and how the link moves."""

    touching: Touching
    sliding: Sliding


@dataclass(frozen=True)
class Plant:
    """A link on its springs and its polymer: modes of a layer that is bonded, or blocks that only push."""

    joint: Joint
    polymer: Modes | Blocks

    @property
    def sides(self) -> tuple[Modes, ...]:
        """Modes of the layer, or of each block."""
        return tuple(self.polymer) if isinstance(self.polymer, Blocks) else (self.polymer,)

    @property
    def size(self) -> int:
        """Count of states: angle, speed, internal angles."""
        return 2 + sum(len(side) for side in self.sides)

    def stiffness(self, period: float) -> float:
        """Return the stiffness [N*m/rad] of springs and of what of one side does not relax within a period [s]."""
        return float(self.joint.spring_stiffness + self._branch(self.sides[0], period))

    @property
    def stiffest(self) -> float:
        """Stiffness before any mode relaxes, all touching [N*m/rad]."""
        return float(self.joint.spring_stiffness + sum(self._branch(side, 0.0) for side in self.sides))

    def _branch(self, side: Modes, period: float) -> float:
        layer = sum(stiffness for time, stiffness in side if time > period)
        return float(self.joint.structure_stiffness * layer / (self.joint.structure_stiffness + layer))

    def torque(self, angle: Array, inner: list[Array], touching: Touching) -> Array:
        """Return the torque of springs and polymer on the link [N*m], friction not counted."""
        if isinstance(self.polymer, Blocks):
            return np.asarray(one_sided.module_torque(angle, inner, touching, self.joint, self.polymer))
        return np.asarray(motion.module_torque(angle, inner, self.joint, self.polymer))

    def internal_rates(self, angle: Array, inner: list[Array], touching: Touching) -> Array:
        """Return the rates of the internal angles [rad/s], one row each."""
        if isinstance(self.polymer, Blocks):
            return np.array(one_sided.internal_rates(angle, inner, touching, self.joint, self.polymer))
        return np.array(motion.internal_rates(angle, inner, self.joint, self.polymer))

    def energy_terms(
        self, angle: Array, speed: Array, inner: list[Array], touching: Touching
    ) -> list[tuple[Array, Array]]:
        """Return pairs (stiffness or inertia c, deflection or speed d) that hold c d^2/2 each [J]."""
        if isinstance(self.polymer, Blocks):
            return one_sided.energy_terms(angle, speed, inner, touching, self.joint, self.polymer)
        return motion.energy_terms(angle, speed, inner, self.joint, self.polymer)

    def energy(self, angle: Array, speed: Array, inner: list[Array], touching: Touching) -> Array:
        """Return the stored energy [J]."""
        return np.asarray(0.5 * sum(c * d**2 for c, d in self.energy_terms(angle, speed, inner, touching)))

    def gap(self, internal: Array) -> float:
        """Return the angle over which nothing touches [rad]; a bonded layer has none."""
        return float(one_sided.gap(list(internal), self.polymer)) if isinstance(self.polymer, Blocks) else 0.0

    def to_energy(self) -> Array:
        """Return the coordinates whose square is twice the energy with all in contact."""
        identity = np.eye(self.size)
        terms = self.energy_terms(identity[0], identity[1], list(identity[2:]), HELD)
        return np.asarray(np.linalg.qr(np.array([np.sqrt(c) * d for c, d in terms]), mode="r"))

    def pulls(self) -> Array:
        """Return the rows that take the state to the blocks' pulls; none where the layer is bonded."""
        identity = np.eye(self.size)
        if not isinstance(self.polymer, Blocks):
            return np.empty((0, self.size))
        return np.array(one_sided.pulls(identity[0], list(identity[2:]), self.polymer))


class Regime:
    """The linear motion of a phase, in coordinates whose square is twice the energy when all touches."""

    def __init__(self, matrix: Array, guards: Array) -> None:
        """Take x' = matrix x and rows of guards: the phase lasts as long as each row times x stays above zero."""
        self.matrix, self.guards = matrix, guards
        self.slopes = guards @ matrix
        self._known: dict[float, Array] = {}

    @cached_property
    def values(self) -> Array:
        """Eigenvalues [1/s]."""
        return np.asarray(np.linalg.eigvals(self.matrix))

    def after(self, state: Array, step: float) -> Array:
        """Return the state a regular step later; its propagator is kept."""
        from scipy.linalg import expm

        if step not in self._known:
            self._known[step] = expm(self.matrix * step)
        return np.asarray(self._known[step] @ state)

    def later(self, state: Array, time: float) -> Array:
        """Return the state any time later."""
        from scipy.linalg import expm

        return np.asarray(expm(self.matrix * time) @ state)

    def leaving(self, guard: int, state: Array, end: Array, step: float) -> float | None:
        """Return the first time [s] in a step at which a guard falls below zero, or None; `end` is the step's state.

        A guard that falls and rises again within the step is examined where it turns.
        """
        row, slope = self.guards[guard], self.slopes[guard]
        starts, ends = float(slope @ state), float(slope @ end)
        if row @ end >= 0.0 and not starts < 0.0 < ends:
            return None
        after = self._zero(slope, state, 0.0, step) if starts < 0.0 < ends else step
        return self._zero(row, state, 0.0, after) if self._at(row, state, after) < 0.0 else None

    def _at(self, row: Array, state: Array, time: float) -> float:
        from scipy.linalg import expm

        return float(row @ expm(self.matrix * time) @ state)

    def _zero(self, row: Array, state: Array, before: float, after: float) -> float:
        """Find where a row of the state passes zero; the nearer end where rounding hides the change of sign."""
        from scipy.optimize import brentq

        ends = {time: self._at(row, state, time) for time in (before, after)}
        if ends[before] * ends[after] >= 0.0:
            return min(ends, key=lambda time: abs(ends[time]))
        return float(brentq(lambda time: self._at(row, state, time), before, after, xtol=SEARCHED * after, rtol=1e-14))


class Course:
    """A motion on its way: where it is, its phase, and what it has come through."""

    def __init__(self, plant: Plant, friction: float = 0.0, omega: float | None = None) -> None:
        """Take the link and the torque that resists it [N*m]; with `omega` [rad/s] it turns as a sine, or stands still.

        `start` comes next. The last state is a constant for the friction's torque.
        """
        self._plant, self._friction, self._omega = plant, friction, omega
        self._to = np.zeros((plant.size + 1, plant.size + 1))
        # A link that is turned gives energy to its polymer: there coordinates of energy only add rounding.
        self._to[:-1, :-1], self._to[-1, -1] = plant.to_energy() if omega is None else np.eye(plant.size), 1.0
        self._from = np.linalg.inv(self._to)
        self._pulls = plant.pulls()
        self._regimes: dict[Phase, Regime] = {}
        self._switched: set[int] = set()
        stiffness = plant.stiffness(0.0) if friction > 0.0 else plant.stiffest
        self.quickest = 2.0 * np.pi * np.sqrt(plant.joint.inertia / stiffness)
        """Period of the joint before any mode relaxes [s]."""
        self._swing = plant.stiffness(self.quickest)
        self._swing *= np.sqrt(self._swing / plant.joint.inertia)
        self._least = 0.0
        self.events: list[ContactEvent] = []

    def start(self, angle: float, speed: float, internal: Array) -> None:
        """Begin here; a block that lies just at the link touches if the link moves towards it.

        A link at rest slides at once where its torque is more than the friction.
        """
        state = np.concatenate([[angle, speed], internal, [1.0]])
        touching = HELD
        if len(self._pulls):
            pulls, approach = self._pulls @ state[:-1], speed * self._pulls[:, 0]
            touching = Touching(*((pulls > 0.0) | ((pulls == 0.0) & (approach > 0.0))).astype(float).tolist())
        self._least = NEGLECTED * abs(angle)
        self.columns, self.durations, self.time = [self._to @ state], list[float](), 0.0
        if self._omega is not None:
            sliding = Sliding.PRESCRIBED
        elif self._friction > 0.0:
            sliding = self._after_a_stop(state, touching)
        else:
            sliding = Sliding.FREE
        self.phase = Phase(touching, sliding)
        self.phases = [self.phase]

    def follow(self, first: float, enough: float, turns: float) -> None:
        """Go on with steps that grow until a block is left or met, the link sticks or comes loose, or all is over."""
        contacts, swings = len(self.events), self.phase.sliding.swings
        values = self._regime(self.phase).values if swings else np.zeros(1)
        for step, count in sampled_motion.growing(first, values):
            for _ in range(count):
                self.across(step)
                if len(self.events) > contacts or self.phase.sliding.swings != swings:
                    return
            if self.over(enough, turns):
                return

    def over(self, enough: float, turns: float) -> bool:
        """Return whether nothing is left to be seen, too much was sampled, or the link has turned round often enough.

        `enough` is the energy [J] that counts as none.
        """
        if self.time >= sampled_motion.LONGEST or len(self.columns) >= sampled_motion.MOST_SAMPLES:
            return True
        if np.isfinite(turns) and len(sampled_motion.turns_of(self._from[1] @ np.column_stack(self.columns))) >= turns:
            return True
        rests = self.phase.sliding in {Sliding.FREE, Sliding.STUCK} and self.driving_energy() <= enough
        return rests or self._spent()

    def _spent(self) -> bool:
        """Return whether a link that creeps has nothing left that drives it: it does so as long as rounding lets it."""
        return self.phase.sliding.creeping and self.driving_energy() <= 0.0

    def driving_energy(self) -> float:
        """Return the energy that may still move the link [J]: all of it, or against friction what is not in springs."""
        angle, speed, *inner = (self._from @ self.columns[-1])[:-1]
        whole = float(self._plant.energy(angle, speed, inner, self.phase.touching))
        springs = float(0.5 * self._plant.joint.spring_stiffness * angle**2)
        return whole if self.phase.sliding is Sliding.FREE else whole - springs

    def states(self) -> Array:
        """Return angle, speed and internal angles, one column a sample."""
        return np.asarray((self._from @ np.column_stack(self.columns))[:-1])

    def motion(self) -> OneSided:
        """Return all it has come through; the torque is that on the link, friction counted."""
        states = self.states()
        touching = Touching(*np.array([phase.touching for phase in self.phases]).T)
        inner = list(states[2:])
        pushed = self._plant.torque(states[0], inner, touching)
        sign = np.array([phase.sliding.sign for phase in self.phases])
        stuck = np.array([phase.sliding is Sliding.STUCK for phase in self.phases])
        moved = Motion(
            times=np.concatenate([[0.0], np.cumsum(self.durations)]),
            angle=states[0],
            speed=states[1],
            internal=states[2:],
            torque=np.where(stuck, 0.0, pushed - sign * self._friction),
            energy=self._plant.energy(states[0], states[1], inner, touching),
            stretches=sampled_motion.stretches_of(self.durations),
        )
        rest_angle = float(states[0, -1]) if self.phase.sliding is Sliding.STUCK or self._spent() else None
        return OneSided(moved, np.array(touching) > 0.0, tuple(self.events), rest_angle)

    def across(self, step: float) -> None:
        """Go on by a step [s], through the events in it."""
        left = step
        while left > SEARCHED * step:
            state, regime = self.columns[-1], self._regime(self.phase)
            end = regime.after(state, left) if left == step else regime.later(state, left)
            ways = ((regime.leaving(guard, state, end, left), guard) for guard in range(len(regime.guards)))
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
        """Return what friction does next to a link that has stopped, or that has come loose."""
        if sliding.creeping:
            return Sliding.STUCK
        if sliding is not Sliding.STUCK:
            return self._after_a_stop(state, touching)
        inner = list(state[2:-1])
        pushed = float(self._plant.torque(state[0], inner, touching))
        # A torque that grows at the rate r makes a link swing by r/(K omega) about where it would be without inertia.
        relaxing = list(self._plant.internal_rates(state[0], inner, touching))
        rising = abs(float(self._plant.torque(np.array(0.0), relaxing, touching)))
        creeps = rising < self._swing * self._least
        return Sliding(("creeping" if creeps else "sliding", float(np.sign(pushed))))

    def _after_a_stop(self, state: Array, touching: Touching) -> Sliding:
        """Return whether friction holds a link at rest, or which way it goes."""
        pushed = float(self._plant.torque(state[0], list(state[2:-1]), touching))
        return Sliding.STUCK if abs(pushed) <= self._friction else Sliding(("sliding", float(np.sign(pushed))))

    def _regime(self, phase: Phase) -> Regime:
        """Return the linear motion of a phase with a constant for the friction's torque; its guards stay above zero."""
        if phase not in self._regimes:
            size = self._plant.size
            rows = np.eye(size, size + 1)
            unit = np.eye(1, size + 1, size)[0]
            inner = list(rows[2:])
            pushed = self._plant.torque(rows[0], inner, phase.touching)
            relaxing = self._plant.internal_rates(rows[0], inner, phase.touching)
            sign, inertia = phase.sliding.sign, self._plant.joint.inertia
            matrix = np.zeros((size + 1, size + 1))
            matrix[2:size] = relaxing
            guards = []
            if phase.sliding in {Sliding.FREE, Sliding.PRESCRIBED}:
                matrix[0] = rows[1]
                matrix[1] = pushed / inertia if self._omega is None else -(self._omega**2) * rows[0]
            elif phase.sliding is Sliding.STUCK:
                guards = [self._friction * unit - pushed, self._friction * unit + pushed]
            elif phase.sliding.creeping:
                # The torque stays that of the friction: what the internal angles take of it the angle gives.
                matrix[0] = -(pushed[2:size] @ relaxing) / pushed[0]
                guards = [sign * matrix[0]]
            else:
                matrix[0] = rows[1]
                matrix[1] = (pushed - sign * self._friction * unit) / inertia
                guards = [sign * rows[1]]
            signs = 2.0 * np.array(phase.touching) - 1.0
            contacts = [side * np.append(pull, 0.0) for side, pull in zip(signs, self._pulls, strict=False)]
            every = np.array([*contacts, *guards]).reshape(-1, size + 1) @ self._from
            self._regimes[phase] = Regime(self._to @ matrix @ self._from, every)
        return self._regimes[phase]
