"""The command `bench`: tests of a built module for a laboratory, and their data against what the model predicts."""
