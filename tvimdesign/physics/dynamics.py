"""The link on its springs and its polymer: I theta'' + b theta' + K theta = T (textbook, one degree of freedom)."""

from __future__ import annotations

from typing import Any

import numpy as np


def natural_frequency(stiffness: Any, inertia: Any) -> Any:
    """Undamped natural frequency, sqrt(K/I)/(2 pi) [Hz]."""
    return np.sqrt(stiffness / inertia) / (2.0 * np.pi)


def damping_ratio(damping: Any, stiffness: Any, inertia: Any) -> Any:
    """b/(2 sqrt(K I)) [1]; 1 is critical."""
    return damping / (2.0 * np.sqrt(stiffness * inertia))
