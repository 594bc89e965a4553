"""Fixed programs, compiled once for an installation: they run CasADi's expressions as data and step them in time."""
