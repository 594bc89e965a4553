"""Answers to states: quick and exact ones, in a process of their own."""
