"""Tests of the whole joint: released, turned as a sine or a step, loaded through a cycle."""
