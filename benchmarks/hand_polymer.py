"""PCL for the rival written by hand: enthalpy over the melting range, and moduli at 1 Hz at both operating points."""

from __future__ import annotations

import math

# Enthalpy of PCL: melts between 50 and 65 degC
C_SOLID, C_MELT, LATENT, MELTS, MOLTEN, ROUNDING = 1850.0, 2100.0, 76750.0, 323.15, 338.15, 1000.0
H_MELTS = C_SOLID * (MELTS - 273.15)
H_MOLTEN = H_MELTS + LATENT + 0.5 * (C_SOLID + C_MELT) * (MOLTEN - MELTS)

OMEGA = 2.0 * math.pi  # rad/s, both operating points at 1 Hz
SOLID_MODES = ((1e10, 0.83776), (10.0, 0.07414), (1.0, 0.06814), (0.1, 0.07545), (0.01, 0.07776), (0.001, 0.10444))
VISCOSITY, PLATEAU = 171.0 * (80.0 / 35.5) ** 3.94, 0.95e6  # Pa s of 80 kg/mol, Pa
SHARES = [10.0 ** (0.1 * i) for i in range(6)]  # two modes a decade, moduli by the time to the power -0.2
LONGEST = VISCOSITY / PLATEAU * sum(SHARES) / sum(share * 10.0 ** (-0.5 * i) for i, share in enumerate(SHARES))
MELT_MODES = [(LONGEST * 10.0 ** (-0.5 * i), PLATEAU * share / sum(SHARES)) for i, share in enumerate(SHARES)]


def _moduli(kelvin: float) -> tuple[float, float]:
    """Storage and loss modulus of PCL at 1 Hz [Pa]; the same for all designs, so worked out once."""
    window = (H_MOLTEN - H_MELTS) / (MOLTEN - MELTS)
    enthalpy = C_SOLID * (min(kelvin, MELTS) - 273.15) + C_MELT * max(kelvin - MOLTEN, 0.0)
    enthalpy += window * min(max(kelvin - MELTS, 0.0), MOLTEN - MELTS)
    first, last = (0.5 * (z + math.hypot(z, ROUNDING)) for z in (enthalpy - H_MELTS, enthalpy - H_MOLTEN))
    frozen = 1.0 - (first - last) / (H_MOLTEN - H_MELTS)
    soft = [0.09 * 5.0 * math.log1p(math.exp((t - 315.15) / 5.0)) for t in (296.15, kelvin)]
    level = 411e6 * math.exp(soft[0] - soft[1]) / (2.0 * 1.45)
    level /= sum(share * (OMEGA * time) ** 2 / (1.0 + (OMEGA * time) ** 2) for time, share in SOLID_MODES)
    shift = math.exp(35e3 / 8.314462618 * (1.0 / kelvin - 1.0 / 373.15))
    storage = loss = 0.0
    for (solid_time, share), (melt_time, melt) in zip(SOLID_MODES, MELT_MODES, strict=True):
        x = OMEGA * solid_time**frozen * (shift * melt_time) ** (1.0 - frozen)
        modulus = (level * share) ** frozen * melt ** (1.0 - frozen)
        storage += modulus * x**2 / (1.0 + x**2)
        loss += modulus * x / (1.0 + x**2)
    return storage, loss


(COLD_STORAGE, COLD_LOSS), (HOT_STORAGE, HOT_LOSS) = _moduli(303.15), _moduli(373.15)
