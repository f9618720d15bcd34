# A few verbs. Each sets up what it needs: a virtual environment in .venv, the package installed in it.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
SCENARIO ?= examples/paper.toml
OUT ?= report
# One thread per process in BLAS: the work is many small problems, and tests run two at a time.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1

.PHONY: help venv install dev test reached quick lint report bench soak clean
help:
	@echo "make report   check the paper's scenario and write its pages to $(OUT)/"
	@echo "make test     every test but the soak"
	@echo "make reached  after make test: functions that claims rest on and no test reached"
	@echo "make quick    the tests that take seconds"
	@echo "make dev      an install that follows the sources, and the hooks that lint before a commit"
	@echo "make lint     ruff, mypy --strict, import contracts, dead code, spelling"
	@echo "make bench    benchmarks, with their competitors where installed"
	@echo "make soak     hours of random attack on what is proved"
	@echo "make clean    remove what these made"

venv: $(VENV)/ready
$(VENV)/ready: pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed")'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade "pip>=24"
	rm -rf build *.egg-info
	$(BIN)/python -m pip install --quiet ".[test]"
	touch $@

# Tests run against the installed package; a stale build folder would put deleted modules in it.
install: venv
	rm -rf build *.egg-info
	$(BIN)/python -m pip install --quiet --no-deps --force-reinstall .
	rm -rf build *.egg-info

# Each of two workers takes half of the tests, then half of what the other has left: files stay
# together (what a module's fixtures make is made once or twice), and neither worker waits for a long file.
TWO := -n 2 --dist worksteal

# Follows the sources: a changed line needs no reinstall, a new file does. `make test` puts the plain install back.
dev: $(VENV)/lint-ready
	$(BIN)/python -m pip install --quiet "pre-commit>=3.5"
	rm -rf build *.egg-info
	$(BIN)/python -m pip install --quiet --no-deps -e . --config-settings editable_mode=strict
	if [ -e .git ]; then $(BIN)/pre-commit install; fi

# Notes too which functions that claims rest on were reached: `make reached` names those that no test reached.
test: install
	rm -rf $(VENV)/reached
	INTERMIT_REACHED=$(abspath $(VENV))/reached $(BIN)/pytest tests -m "not soak" $(TWO)

reached:
	$(BIN)/python tests/reached.py $(VENV)/reached

quick: install
	$(BIN)/pytest tests -m "not soak and not slow" $(TWO)

$(VENV)/lint-ready: $(VENV)/ready
	$(BIN)/python -m pip install --quiet "ruff>=0.6" "mypy>=1.10" "import-linter>=2.6" "vulture>=2.11" "codespell>=2.3"
	touch $@

lint: install $(VENV)/lint-ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy --config-file pyproject.toml -p intermit
	$(BIN)/lint-imports --config pyproject.toml
	$(BIN)/vulture
	$(BIN)/codespell

report: install
	$(BIN)/intermit report $(SCENARIO) -o $(OUT)

$(VENV)/bench-ready: $(VENV)/ready
	$(BIN)/python -m pip install --quiet ".[fast,bench]" || echo "some competitors could not be installed: they are skipped by name"
	rm -rf build *.egg-info
	touch $@

bench: install $(VENV)/bench-ready
	$(BIN)/python benchmarks/run.py

soak: install
	$(BIN)/pytest tests -m soak $(TWO)

clean:
	rm -rf $(VENV) build dist *.egg-info $(OUT) .mypy_cache .ruff_cache .pytest_cache .import_linter_cache .hypothesis
