"""The link on its springs and its polymer: I theta'' + b theta' + K theta = T (textbook, one degree of freedom)."""

from __future__ import annotations

from typing import Any

import numpy as np


def natural_frequency(stiffness: Any, inertia: Any) -> Any:
    """Undamped natural frequency, sqrt(K/I)/(2 pi) [Hz]."""
    return np.sqrt(stiffness / inertia) / (2.0 * np.pi)


def critical_damping(stiffness: Any, inertia: Any) -> Any:
    """Damping above which nothing rings, 2 sqrt(K I) [N*m*s/rad]."""
    return 2.0 * np.sqrt(stiffness * inertia)


def damping_ratio(damping: Any, stiffness: Any, inertia: Any) -> Any:
    """Damping over the critical one [1]."""
    return damping / critical_damping(stiffness, inertia)
