"""Sizes thermo-active variable impedance modules: a study file in, a module that can be made out."""

__version__ = "0.1.0"
