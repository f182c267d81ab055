# Two commands matter: `make demo` and `make test`. Both set up .venv first, from requirements.lock.

PYTHON ?= python3
BIN := .venv/bin
READY := .venv/.ready
PACKAGES := anchoring chronicles dyknow networks perception traffic

.PHONY: help setup demo test check fix lock networks recordings figures clean

help:                ## Show this list
	@grep -E '^[a-z]+: .*##|^[a-z]+:  +##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*##/\t/' | expand -t 12

setup: $(READY)      ## Install everything into .venv, as locked

$(READY): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	  echo "Python 3.11 or newer is needed; set PYTHON=... to say which one to use." >&2; exit 2; }
	@$(PYTHON) -m venv .venv || { \
	  echo "Could not make .venv; on Debian and Ubuntu: apt-get install python3-venv" >&2; exit 2; }
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	$(BIN)/python -m traffic.sumo.libraries
	@touch $(READY)

demo: setup          ## Simulate, film, track, anchor, recognise, and report
	$(BIN)/traffic run crossing

test: check          ## All checks and all tests
	$(BIN)/pytest -n 2

check: setup         ## Format, lint, types and layers; no tests
	$(BIN)/ruff format --check
	$(BIN)/ruff check
	$(BIN)/mypy
	$(BIN)/lint-imports

fix: setup           ## Format, and mend what the linter can mend
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

lock: setup          ## Resolve the dependencies again (needs uv)
	uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-emit-index-url \
	  --extra dev --custom-compile-command "make lock" pyproject.toml -o requirements.lock

networks: setup      ## Compile the bundled road networks again (needs the extra "build")
	$(BIN)/traffic network build data/networks/crossing data/networks/crossing/crossing.net.xml --force
	$(BIN)/traffic network build data/networks/rural data/networks/rural/rural.net.xml --force
	$(BIN)/traffic network build data/networks/avenue data/networks/avenue/avenue.net.xml --force
	$(BIN)/traffic network build data/networks/quarter data/networks/quarter/quarter.net.xml --force
	$(BIN)/traffic network build data/networks/high_street data/networks/high_street/high_street.net.xml --force
	$(BIN)/traffic network build data/networks/long_road data/networks/long_road/long_road.net.xml --force

recordings: setup    ## Do the runs of the regression suite again and cut new recordings (a quarter of an hour)
	$(BIN)/traffic regress --remake

figures: setup       ## Make the figures of the README again (four hours; a processor of its own for the last two)
	$(BIN)/traffic experiment accuracy --out figures/accuracy
	$(BIN)/traffic experiment library --out figures/library
	for design in table-8.2-seed table-8.2 look-alikes table-8.2-beyond table-8.2-dropout table-8.2-delay; do \
	  $(BIN)/traffic experiment $$design --out figures/$$design || exit 1; done
	$(BIN)/traffic report table-8.2-published figures/table-8.2-seed figures/table-8.2 --html figures/table-8.2.html
	taskset -c 0 $(BIN)/traffic run crossing --out figures/crossing
	taskset -c 0 $(BIN)/traffic benchmark chronicles --out figures/chronicles

clean:               ## Remove what the other targets made
	rm -rf .venv .mypy_cache .ruff_cache .pytest_cache .hypothesis build dist
