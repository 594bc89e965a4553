# The front door. Each target makes what it needs: a fresh machine has Python 3.11 or newer with pip and venv, no more.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
RUNS := $(VENV)/.runs

.DEFAULT_GOAL := help
.PHONY: help study wheel release test test-gate test-all test-slow bench bench-switch bench-choices bench-shelf bench-cad bench-sweep bench-cells bench-front bench-designs bench-random-choices bench-explore bench-engine bench-slider gallery screenshots fuzz kills folders sweep-kills random-studies time-limits machine same same-optima validation fit-coverage check-wheel check-cad docs pictures lint format types contracts words prose page-code schema units vendor cad clean

help:  ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

# Modules are compiled when they are first imported: most that are installed never are.
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile -c constraints.txt

$(RUNS): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(PIP) -e '.[cad]'
	@touch $@

$(STAMP): $(RUNS)
	$(PIP) -e '.[dev]'
	@touch $@

study: $(RUNS)  ## run studies/elbow_printed.yaml and say where the results are
	$(BIN)/tvimdesign run studies/elbow_printed.yaml --overwrite

# Two workers for two processors: a library that starts threads of its own in each would only be in their way.
PYTEST := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -q -n 2 --dist loadfile --no-loadscope-reorder

test: $(STAMP)  ## the fast tests
	$(PYTEST)

test-gate: $(STAMP)  ## the tests of some seconds each, which the gate runs beside the fast ones
	$(PYTEST) -m 'gate and not slow'

test-all: $(STAMP)  ## all tests, the long ones too
	$(PYTEST) -m ''

test-slow: $(STAMP)  ## the long tests alone
	$(PYTEST) -m slow

BENCH := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python

$(VENV)/.bench: $(STAMP)
	$(PIP) -e '.[dev,bench]'
	@touch $@

bench: $(VENV)/.bench bench-switch bench-choices bench-sweep bench-front bench-cad  ## everything against what people would use instead, side by side (minutes)
	$(BENCH) benchmarks/optimum.py

bench-switch: $(STAMP)  ## one switch simulated here and by scipy, side by side
	$(BENCH) benchmarks/switch.py

bench-choices: $(STAMP)  ## the best of two thousand combinations by branch and bound, and all of them accounted for
	$(BENCH) benchmarks/choices.py

bench-shelf: $(STAMP)  ## the best three of some 50,000 combinations of heater, process, steel, wire and counts, in both modes
	$(BENCH) benchmarks/shelf.py

bench-sweep: $(STAMP)  ## designs a second through compiled equations, and through what else there is
	$(BENCH) benchmarks/sweep.py
	$(BENCH) benchmarks/sweep.py --study benchmarks/reference.yaml

bench-cells: $(STAMP)  ## what a sweep of 2,000 cells costs beside its cells: processes, scaling, a resume, bytes a cell
	$(BENCH) benchmarks/sweep_cells.py
	$(BENCH) benchmarks/sweep_cells.py --cells 200 --task optimize
	$(BENCH) benchmarks/sweep_cells.py --cells 20 --task cold

bench-front: $(VENV)/.bench  ## a front of thirty designs, against NSGA-II by hypervolume
	$(BENCH) benchmarks/front.py

bench-explore: $(STAMP)  ## the explorer's drags: time to the answer, evaluated and optimised, on the paper's module; then 1,000 random drags
	$(BENCH) benchmarks/explore_drags.py --leak 1000

bench-engine: $(STAMP)  ## recording, an evaluation with its gradient, a solve, and steps, of four studies (half a minute)
	$(BENCH) benchmarks/engine.py

bench-designs: $(STAMP)  ## random designs within the studies' bounds: refused by a named rule, or sound parts
	$(BENCH) benchmarks/random_designs.py

bench-random-choices: $(STAMP)  ## 200 random choices of heater, process, spring and fixtures: refused by name, or sound parts
	$(BENCH) benchmarks/random_choices.py --inspect --out build/random_choices.jsonl

fuzz: $(STAMP)  ## mutated inputs of every kind, from studies to the explorer's messages: each is read or refused in words (minutes)
	OMP_NUM_THREADS=1 $(BIN)/python campaigns/fuzz.py

kills: $(STAMP)  ## end every command at random moments, and look at what is left (an hour)
	$(BIN)/python campaigns/kills.py

folders: $(STAMP)  ## 10,000 random folders with a user's files under every command: no byte of theirs is changed (minutes)
	OMP_NUM_THREADS=1 $(BIN)/python campaigns/folders.py

sweep-kills: $(STAMP)  ## end jobs of an array of a sweep, and compare the tables (minutes)
	$(BIN)/python campaigns/sweep_kills.py

random-studies: $(STAMP)  ## whole searches of random studies, each answer attacked by random search, evolution and COBYLA (minutes)
	$(BIN)/python campaigns/random_studies.py

time-limits: $(STAMP)  ## every shipped study with time limits of 5, 20 and 60 s: each is kept, and the reason given is the right one (half an hour)
	$(BIN)/python campaigns/time_limits.py

machine: $(STAMP)  ## a run without room, descriptors, memory, a home or letters: done, or one line and the right code (minutes)
	$(BIN)/python campaigns/machine.py

SAME := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python campaigns/same.py
SAME_STUDIES := $(if $(ONLY),--studies $(ONLY))

same: $(STAMP)  ## compare outputs, parts, fits and messages with the frozen ones (minutes); ONLY="finger ankle", TOLERANCE=1e-9
	$(SAME) $(SAME_STUDIES) $(if $(TOLERANCE),--tolerance $(TOLERANCE))

same-optima: $(STAMP)  ## search the studies again and compare the optima with the frozen ones (half an hour); ONLY="finger ankle"
	$(SAME) --only optima $(SAME_STUDIES)

validation: $(STAMP)  ## compare with handbooks, closed solutions, FE and published data, and write docs/validation.md (minutes)
	$(BENCH) validation/run.py

fit-coverage: $(STAMP)  ## how often the intervals of fits hold the truth, over 100 seeds of every kind, without and with faults; goes on where it was left (40 minutes)
	$(BENCH) benchmarks/fit_coverage.py
	$(BENCH) benchmarks/fit_coverage.py --faults

check-wheel: $(STAMP)  ## fit, verify and validation from a wheel outside the repository; FE_PYTHON=... names a Python that has ngsolve (minutes)
	$(BIN)/python -m pytest -q -m slow tests/test_wheel.py

lint: $(STAMP) types contracts words prose page-code  ## ruff, mypy, import contracts, words of names, lengths of sentences; eslint and tsc for the page's code (needs npm)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP)
	$(BIN)/mypy

contracts: $(STAMP)
	$(BIN)/lint-imports

words: $(STAMP)  ## private words in names, messages and docs: no floor has more than its allowance; `--update` lowers it
	$(BIN)/python .ci/words/words.py

prose: $(STAMP)  ## sentences of README, docs and help: a mean below 18 words, none above 35
	$(BIN)/python .ci/words/prose.py

PAGE := .ci/page
PAGE_BIN := $(PAGE)/node_modules/.bin
$(PAGE)/node_modules/.stamp: $(PAGE)/package.json $(PAGE)/package-lock.json
	npm ci --prefix $(PAGE) --no-audit --no-fund --silent
	@touch $@

page-code: $(PAGE)/node_modules/.stamp
	$(PAGE_BIN)/eslint --config $(PAGE)/eslint.config.js tvimdesign/report/page/static tvimdesign/explore/static
	$(PAGE_BIN)/tsc --project $(PAGE)/tsconfig.json

format: $(STAMP)  ## let ruff put the code in form
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

wheel: $(STAMP)  ## build wheel and source archive into dist/
	rm -rf dist
	$(BIN)/python -m build --outdir dist .

release: wheel  ## build, look at it with twine, and use the wheel in empty environments: the light package, each extra alone
	$(BIN)/python -c "import pathlib, tvimdesign; list(map(tvimdesign.read_design, pathlib.Path('cad').glob('*/design.json')))"
	$(BIN)/python -m twine check --strict dist/*
	$(BIN)/python release/check_wheel.py dist/tvimdesign-*.whl --constraints constraints.txt

vendor: $(STAMP)  ## bundle the libraries of the report page anew from their pinned packages (needs npm)
	$(BIN)/python vendor/vendor.py

schema: $(STAMP)  ## write study.schema.json, for editors, from the table
	$(BIN)/tvimdesign schema > study.schema.json

units: $(STAMP)  ## write the usual units as pint reads them
	$(BIN)/python -m tvimdesign.base.units

SHOTS := docs/pictures/report.png docs/pictures/explorer.png
docs: $(STAMP) $(SHOTS)  ## build the docs site into build/site: strict, links checked, nothing loaded from the network
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet --strict
	@echo "the site is in build/site: open build/site/index.html"

# What a study's run leaves; made anew where the study is newer than its report.
results/%/report.html: studies/%.yaml $(STAMP)
	$(BIN)/tvimdesign run $< --out results/$* --overwrite --no-plots

STUDIES := $(basename $(notdir $(wildcard studies/*.yaml)))
gallery: $(STUDIES:%=results/%/report.html) docs  ## the docs site with the reports of all shipped studies (an hour)

# The site takes them where they are not there; `make screenshots` takes them anew.
$(SHOTS) &:
	$(MAKE) screenshots

screenshots: results/elbow_printed/report.html  ## take docs/pictures/report.png and explorer.png in a browser
	$(BIN)/python docs/make/screenshots.py

bench-slider: $(VENV)/.bench  ## one slider of the explorer beside the same in trame and in Panel, in one browser
	PYTHONPATH=tests/helpers $(BENCH) benchmarks/slider.py

pictures: $(STAMP)  ## draw docs/pictures anew: labelled sections, and every study's module from a run with parts (minutes)
	$(BIN)/python docs/make/section_drawing.py
	$(BIN)/python docs/make/plan_drawing.py
	$(BIN)/python docs/make/joint_drawing.py
	for study in studies/*.yaml; do $(BIN)/tvimdesign run $$study --overwrite --no-plots || exit 1; done
	$(BIN)/python docs/make/study_pictures.py

REFERENCES := elbow_printed wrist_compression
cad: $(STAMP)  ## write the reference parts in cad/ for a release, from a module of each mode
	rm -rf $(addprefix cad/,$(REFERENCES))
	for name in $(REFERENCES); do \
	  $(BIN)/tvimdesign run studies/$$name.yaml --out results/$$name --overwrite --no-plots || exit 1; \
	  mkdir -p cad/$$name; \
	  cp results/$$name/design.json $(addprefix results/$$name/cad/,preview.png bom.csv assembly.md assembly.step) cad/$$name/; \
	done

check-cad: $(STAMP)  ## slice the printed parts and read the STEP files with other programs from Debian (prusa-slicer, gmsh)
	$(BIN)/python benchmarks/check_cad.py

bench-cad: $(STAMP)  ## the complete set of files, against plain calls of the CAD kernel for the same
	$(BENCH) benchmarks/cad_files.py

clean:  ## remove the environment and all results
	rm -rf $(VENV) results build *.egg-info
