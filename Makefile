# Two commands do everything: `make walk` and `make test`. Each creates the environment it needs.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
ROBOT ?= strider
OUT ?= walk

.PHONY: walk test lint types tests bench figures schema clean

walk: $(VENV)/.run
	$(BIN)/tarsus walk $(ROBOT) --out $(OUT)

test: lint types tests

lint: $(VENV)/.dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports --no-cache

types: $(VENV)/.dev
	$(BIN)/mypy

tests: $(VENV)/.dev
	$(BIN)/python -m pytest -n auto --cov --cov-report=
	$(BIN)/coverage report
	$(BIN)/coverage report --fail-under=100 --include='src/tarsus/errors.py,src/tarsus/arrays.py,src/tarsus/blocks.py,src/tarsus/robot/*,src/tarsus/kinematics/*,src/tarsus/gait/*,src/tarsus/load/*,src/tarsus/load/handbook/*'

bench: $(VENV)/.dev
	$(BIN)/python benchmarks/run.py

figures: $(VENV)/.dev
	$(BIN)/python docs/make_figures.py
	$(BIN)/python docs/refresh.py

schema: $(VENV)/.dev
	$(BIN)/tarsus robots schema > src/tarsus/robot/robot.schema.json

clean:
	rm -rf $(VENV) .mypy_cache .ruff_cache .pytest_cache .hypothesis .coverage walk build dist benchmarks/build

# The environment for walking is small; the one for developing adds the checkers and the references of the tests.
$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "Tarsus needs Python 3.11 or newer; $(PYTHON) is $$($(PYTHON) --version). Try: make PYTHON=python3.12 $(MAKECMDGOALS)"; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.run: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[cli,plots]'
	@touch $@

$(VENV)/.dev: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	@touch $@ $(VENV)/.run
