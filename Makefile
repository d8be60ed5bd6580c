# make run: fold the standard slice.  make test: everything that must hold.
PYTHON ?= python3
VENV ?= .venv
NEWEST ?= .venv-newest
# every how many of the slow tests are run
SAMPLE ?= 1
BIN = $(VENV)/bin

.PHONY: run test check slow newest mutants docs bench clean

run: $(VENV)/.run
	$(BIN)/gyrify run --preset reference-slice --out runs/reference-slice --overwrite

test: $(VENV)/.test
	$(BIN)/python -m ruff format --check .
	$(BIN)/python -m ruff check .
	$(BIN)/python -m mypy
	$(BIN)/python -m pytest -m "not slow" -n auto

slow: $(VENV)/.test
	$(BIN)/python -m pytest -m slow -n auto --sample $(SAMPLE)

# the newest versions of all dependencies, without the pins: PYTHON=python3.13 make newest
newest:
	$(PYTHON) -m venv --clear $(NEWEST)
	$(NEWEST)/bin/python -m pip install --quiet --disable-pip-version-check \
	  --upgrade --upgrade-strategy eager -e ".[fast,test,docs]"
	$(NEWEST)/bin/python -m pytest -m "not slow" -n auto

docs: $(VENV)/.docs
	$(BIN)/sphinx-build -W --keep-going -q -b html docs docs/_build
	@echo "docs/_build/index.html"

mutants: $(VENV)/.test
	$(BIN)/python tools/mutants.py

$(VENV)/.venv:
	@$(PYTHON) -c "import sys; sys.version_info >= (3, 11) or sys.exit('gyrify needs Python 3.11 or newer; set PYTHON=...')"
	$(PYTHON) -m venv $(VENV)
	touch $@

$(VENV)/.run: $(VENV)/.venv pyproject.toml constraints.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[fast]"
	touch $@

$(VENV)/.test: $(VENV)/.venv pyproject.toml constraints.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[fast,test,docs]"
	touch $@

$(VENV)/.docs: $(VENV)/.venv pyproject.toml constraints.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e ".[fast,docs]"
	touch $@

# what it costs, alone and beside other libraries, in an environment of its own; BENCH=--all, --quick, ...
bench: $(VENV)/.venv
	$(BIN)/python benchmarks $(BENCH)

clean:
	rm -rf $(VENV) $(NEWEST) .venv-plain benchmarks/.venv docs/_build
