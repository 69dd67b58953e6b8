# crankcheck: everything sets itself up in .venv with Python 3.11 or later, git and make.
#
#   make verify       compare the engines with the reference on all shipped scenes
#   make test         lint, types and tests
#   make quick        the tests that reach the difference from main, or FILES="reports/page"
#   make report       run the shipped study into out/, with its page, figures and summary
#   make picture      draw the README picture again after make engines: speed against error of each
#   make hard         hard cases, graded, into out/hard
#   make engines      install all engines that this system has, compare them in out/engines
#   make slow         the long checks that `make test` leaves out
#   make docs         build the documentation into out/docs: every example run, every link checked
#   make benchmarks   speed of the reference, of logging and of free motion, as ratios
#   make oldest       compare and test with the oldest packages that pyproject.toml admits
#   make release      build wheel and source archive into out/dist, check and install them
#   make models       write the MJCF files in models/canonical/ again
#   make format       format the code

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check

.PHONY: verify test lint pytest quick record browser report picture hard engines slow docs benchmarks \
	oldest release models format clean

verify: $(VENV)/crankcheck
	$(BIN)/crankcheck verify

# Compiled code is kept: the tests start hundreds of processes, and each would compile it again.
unexport PYTHONDONTWRITEBYTECODE

test: $(VENV)/test browser
	$(MAKE) --no-print-directory --jobs 2 lint pytest

lint: | $(VENV)/test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# One thread for each of the two processes: more threads of large products wait for a processor, and
# took a fifth of the time of ten thousand steps of free motion.
pytest slow: export OPENBLAS_NUM_THREADS := 1

# Stolen work keeps both processes busy to the end, and the tests of a folder, which share fixtures,
# mostly in one of them.
pytest: | $(VENV)/test
	$(BIN)/python -m pytest -q -n 2 --dist worksteal -m "not slow and not long" $(PYTEST)

quick: $(VENV)/test browser
	$(BIN)/python -m tests.recorded.quick $(FILES)

record: $(VENV)/test browser
	$(BIN)/python -m tests.recorded.quick record

# The page of `crankcheck report` is tested in a real browser, which is installed if that needs no
# question (as root on Debian); else its tests are skipped and name the way to install it.
browser:
	@command -v chromium >/dev/null || [ "$$(id -u)" != 0 ] || ! command -v apt-get >/dev/null || \
		{ apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq chromium; } \
		>/dev/null || echo "chromium could not be installed: apt-get install chromium"

report: $(VENV)/crankcheck
	$(BIN)/crankcheck sweep -o out/study
	$(BIN)/crankcheck report out/study -o out/report.html
	$(BIN)/crankcheck report out/study --format md -o out/summary.md
	$(BIN)/crankcheck figures out/study -o out/figures

picture: $(VENV)/crankcheck
	$(BIN)/crankcheck sweep fourbar-lecture-1 --engine all --profile as-shipped --profile tuned --turns 2 \
		--steps-per-turn 90,180,360,720,1440 --jobs 1 -o out/picture
	$(BIN)/crankcheck figures out/picture --only work-precision --scene fourbar-lecture-1 \
		--width-mm 140 --no-title --no-notes --format svg -o docs/images

hard: $(VENV)/crankcheck
	$(BIN)/crankcheck stability -o out/hard

# Four mechanisms, two free motions, and twelve quick hard cases of all kinds.
ALL := --engine all --profile tuned --profile as-shipped -o out/engines
FOUR := fourbar-lecture-1 slider-crank-offset slotted-lever shaper
HARD := heavy-rocker light-rocker heavy-block massless-coupler short-rod grashof-excess triad-near-limit \
	coarse-step speed-same-steps far-away open-joint wrong-velocity
engines: $(VENV)/engines
	$(BIN)/crankcheck sweep $(FOUR) $(ALL) --forces --steps-per-turn 45,90,180,360,720,1440
	$(BIN)/crankcheck sweep fourbar-swing double-pendulum $(ALL) --free --dt 2e-3,1e-3,5e-4 --no-timing
	$(BIN)/crankcheck stability $(HARD) --engine all --profile tuned -o out/engines
	$(BIN)/crankcheck report out/engines -o out/engines.html

slow: $(VENV)/test browser
	$(BIN)/python -m pytest -q -n 2 --dist worksteal -m "slow and not long" $(PYTEST)

docs: $(VENV)/docs
	$(BIN)/python -m docs.site

benchmarks: $(VENV)/benchmark
	$(BIN)/python benchmarks/reference.py
	$(BIN)/python benchmarks/forces.py
	$(BIN)/python benchmarks/logging.py
	$(BIN)/python benchmarks/window_chain.py
	$(BIN)/python benchmarks/free.py
	$(BIN)/python benchmarks/elastic_engines.py --few

# Each lower bound of a dependency as a pin; other packages of the tests are as always.
OLDEST := out/oldest/bin
oldest: $(VENV)/crankcheck
	rm -rf out/oldest && $(BIN)/python -m venv out/oldest
	$(BIN)/python -c 'import tomllib; \
		own = tomllib.load(open("pyproject.toml", "rb"))["project"]["dependencies"]; \
		print(*own, sep="\n")' | sed 's/>=/==/' > out/oldest/bounds.txt
	$(OLDEST)/python -m pip install --quiet --disable-pip-version-check --requirement out/oldest/bounds.txt \
		--editable . hypothesis pytest
	$(OLDEST)/crankcheck verify
	for engine in mujoco pymunk; do $(OLDEST)/crankcheck engines check $$engine || exit; done
	$(OLDEST)/python -m pytest -q tests/reports/cli/test_each_command.py -W ignore::DeprecationWarning

# Each Python of 3.11 or later here installs the wheel, also those of pyenv.
PYTHONS ?= python3.11 python3.12 python3.13 python3.14
release: export PIP_CONSTRAINT := constraints.txt
release: $(VENV)/release
	rm -rf out/dist out/wheel
	$(BIN)/python -m build --outdir out/dist .
	$(BIN)/twine check --strict out/dist/*
	export PYENV_VERSION="$$(pyenv versions --bare 2>/dev/null | paste -sd:)"; \
	for python in $(PYTHONS); do \
		$$python --version 2>/dev/null || { echo "$$python: not here"; continue; }; \
		$$python -m venv out/wheel/$$python && \
		out/wheel/$$python/bin/pip install --quiet --disable-pip-version-check out/dist/*.whl && \
		out/wheel/$$python/bin/crankcheck verify || exit; \
	done

models: $(VENV)/crankcheck
	for scene in fourbar-lecture-1 slider-crank-central; do \
		$(BIN)/crankcheck export $$scene -o models/canonical/$$scene.xml || exit; \
	done

format: $(VENV)/test
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

clean:
	rm -rf $(VENV) .mypy_cache .ruff_cache .pytest_cache .hypothesis .recorded

$(BIN)/python:
	$(PYTHON) -c 'import sys; v = sys.version_info; sys.exit(v < (3, 11) and f"crankcheck needs Python 3.11 or later; {sys.executable} is {v[0]}.{v[1]}. Try: make PYTHON=python3.12")'
	$(PYTHON) -m venv $(VENV)

# pip itself is pinned, as dependency groups need a recent one.
$(VENV)/crankcheck: pyproject.toml constraints.txt | $(BIN)/python
	$(PIP) install --constraint constraints.txt pip
	$(PIP) install --constraint constraints.txt --build-constraint constraints.txt --editable .
	touch $@

$(VENV)/test: $(VENV)/crankcheck
	$(PIP) install --constraint constraints.txt --group test
	touch $@

# One by one: an engine without a wheel for this system does not stop the others; `--engine all` names it.
$(VENV)/engines: $(VENV)/crankcheck
	for extra in box2d dart exudyn rapier simbody drake bullet; do \
		$(PIP) install --constraint constraints.txt --only-binary :all: --no-binary crankcheck \
			--editable ".[$$extra]" || echo "crankcheck[$$extra] could not be installed"; \
	done
	touch $@

$(VENV)/docs: $(VENV)/crankcheck
	$(PIP) install --constraint constraints.txt --group docs
	touch $@

$(VENV)/release: $(VENV)/crankcheck
	$(PIP) install --constraint constraints.txt --group release
	touch $@

$(VENV)/benchmark: $(VENV)/crankcheck
	$(PIP) install --constraint constraints.txt --group benchmark
	touch $@
