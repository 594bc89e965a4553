# The front door. Each target makes what it needs: a fresh machine has Python 3.11 or newer with pip and venv, no more.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.DEFAULT_GOAL := help
.PHONY: help study test test-all test-slow bench bench-switch bench-designs lint format types contracts schema cad clean

help:  ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

$(STAMP): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	@touch $@

study: $(STAMP)  ## run studies/paper_shear.yaml and say where the results are
	$(BIN)/tvimdesign run studies/paper_shear.yaml --overwrite

test: $(STAMP)  ## the fast tests
	$(BIN)/python -m pytest -q -n 2 --dist loadfile

test-all: $(STAMP)  ## all tests, the long ones too
	$(BIN)/python -m pytest -q -n 2 --dist loadfile -m ''

test-slow: $(STAMP)  ## the long tests alone
	$(BIN)/python -m pytest -q -n 2 --dist loadfile -m slow

BENCH := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python

$(VENV)/.bench: $(STAMP)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev,bench]'
	@touch $@

bench: $(VENV)/.bench bench-switch  ## everything against what people would use instead, side by side (minutes)
	$(BENCH) benchmarks/optimum.py

bench-switch: $(STAMP)  ## one switch simulated here and by scipy, side by side
	$(BENCH) benchmarks/switch.py

bench-designs: $(STAMP)  ## random designs within the studies' bounds: refused by a named rule, or sound parts
	$(BENCH) benchmarks/random_designs.py

lint: $(STAMP) types contracts  ## ruff, mypy, import contracts
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP)
	$(BIN)/mypy

contracts: $(STAMP)
	$(BIN)/lint-imports

format: $(STAMP)  ## let ruff put the code in form
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

schema: $(STAMP)  ## write the study's JSON Schema from the table, and the usual units as pint reads them
	$(BIN)/python -m tvimdesign.study.schema
	$(BIN)/python -m tvimdesign.units

# Of the compression module what is not in cad/ is made from its design.json: meshes and assembly would be 5 MB.
cad: $(STAMP)  ## write the reference parts in cad/ from the studies of the paper's modules
	$(BIN)/tvimdesign run studies/paper_shear.yaml --out results/reference --overwrite --no-plots --no-cad
	$(BIN)/tvimdesign cad results/reference/design.json --out cad/paper_shear --overwrite
	$(BIN)/tvimdesign run studies/paper_compression.yaml --out results/reference_compression --overwrite --no-plots
	mkdir -p cad/paper_compression/parts
	cp results/reference_compression/design.json results/reference_compression/cad/checks.json \
	  results/reference_compression/cad/preview.png cad/paper_compression/
	cp results/reference_compression/cad/parts/*.step cad/paper_compression/parts/

clean:  ## remove the environment and all results
	rm -rf $(VENV) results build *.egg-info
