# Three commands do everything: `make studio`, `make walk`, `make test`. Each creates the environment it needs.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
ROBOT ?= strider
OUT ?= walk
# JAX takes half the time to compile so; an XLA that does not know the option ends with an error, hence not in the tests.
COMPILE_FAST := XLA_FLAGS=--xla_cpu_use_fusion_emitters=false

.PHONY: studio walk test lint types tests web web-check browser protocol bench servos figures truth hour train sketch schema clean

studio: $(VENV)/.run web
	$(BIN)/tarsus studio $(ROBOT)

walk: $(VENV)/.run
	$(BIN)/tarsus walk $(ROBOT) --out $(OUT)

# The checks that use one core each run side by side, before the tests, which use all.
test:
	$(MAKE) --no-print-directory -j3 lint types web-check
	$(MAKE) --no-print-directory tests

lint: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports --no-cache

types: $(VENV)/.dev
	$(BIN)/mypy

tests: $(VENV)/.dev web browser
	$(COMPILE_FAST) $(BIN)/python -m pytest -n auto --dist worksteal --cov --cov-report=
	$(BIN)/coverage report
	$(BIN)/coverage report --fail-under=100 --include='src/tarsus/errors.py,src/tarsus/arrays.py,src/tarsus/blocks.py,src/tarsus/robot/*,src/tarsus/kinematics/*,src/tarsus/gait/*,src/tarsus/control/*,src/tarsus/load/*,src/tarsus/load/handbook/*,src/tarsus/simulation/*'

# The studio's pages; Node is the machine's, or is put into the environment.
web: | $(VENV)/bin/python
	$(BIN)/python hatch_build.py

web-check: | $(VENV)/.dev
	$(BIN)/python hatch_build.py check size

# The end-to-end tests drive a real Chromium.
browser:
	@command -v chromium >/dev/null || { \
	  if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; then \
	    apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium; \
	  else echo "The tests of the studio need Chromium as the command chromium: install your system's package of that name."; exit 1; fi; }

protocol: $(VENV)/.dev
	$(BIN)/python -m tarsus.studio.messages.typescript web/src/protocol.ts

bench: $(VENV)/.dev web
	$(BIN)/python benchmarks/run.py

# Servo buses and faults, a few minutes each: the tables of docs/buses.md and docs/first-hour.md; an hour of robot time, fuzzed.
servos: $(VENV)/.dev
	$(BIN)/python benchmarks/servo_buses.py --write
	$(BIN)/python docs/fault_times.py
	$(BIN)/python benchmarks/servo_plant.py --fuzz 3600

figures: $(VENV)/.dev web browser
	$(BIN)/python docs/make_figures.py
	$(BIN)/python docs/make_screenshots.py
	$(BIN)/python docs/refresh.py

# How far plans are true in physics: the tables of docs/how-true.md; walks over rough ground: those of docs/ground-measured.md.
truth: $(VENV)/.dev
	$(BIN)/python docs/how_true.py
	$(BIN)/python docs/statics_true.py
	$(BIN)/python docs/compensation_true.py
	$(BIN)/python docs/faults.py
	$(BIN)/python docs/rough_ground.py
	$(BIN)/python docs/gaits_on_ground.py
	$(BIN)/python docs/other_presets.py
	$(BIN)/python docs/random_robots.py
	$(BIN)/python docs/long_walks.py
	$(BIN)/python docs/other_physics.py
	$(BIN)/python docs/seen_ground.py
	$(BIN)/python docs/cross_slopes.py
	$(BIN)/python docs/put_down.py
	$(BIN)/python docs/edges.py
	$(BIN)/python docs/obstacles.py
	$(BIN)/python docs/sensor_faults.py
	$(BIN)/python docs/leg_failures.py
	$(BIN)/python docs/estimated_contacts.py
	$(BIN)/python docs/ablation.py

# An hour of walks in physics with robots, terrain, commands and faults drawn at random: a table of docs/ground-measured.md.
hour: $(VENV)/.dev
	$(BIN)/python docs/random_hour.py --minutes 60

# Trains policies for a few minutes each: the figure and the tables of docs/reinforcement-learning.md.
train: $(VENV)/.dev
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[rl]'
	$(BIN)/python examples/train_walk.py --actions residual joint --page docs/reinforcement-learning.md

# The Arduino sketch, compiled with g++, against the emulated board.
sketch: $(VENV)/.dev
	$(BIN)/python examples/pulse_lines/check/check.py

schema: $(VENV)/.dev
	$(BIN)/tarsus robots schema > src/tarsus/robot/robot.schema.json

clean:
	rm -rf $(VENV) .mypy_cache .ruff_cache .pytest_cache .hypothesis .coverage walk build dist benchmarks/build web/node_modules src/tarsus/studio/web_dist

# The environment for walking and the studio includes physics; the one for developing adds the checkers and the references of the tests.
$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "Tarsus needs Python 3.11 or newer; $(PYTHON) is $$($(PYTHON) --version). Try: make PYTHON=python3.12 $(MAKECMDGOALS)"; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.run: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[cli,plots,hardware,sim,studio]'
	@touch $@

$(VENV)/.dev: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	@touch $@ $(VENV)/.run
