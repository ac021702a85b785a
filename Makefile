# The two commands of the README. Each sets everything up on a fresh machine with Python ≥ 3.11 and make.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: dock test test-all lint docs gallery bench figures validation clean

dock: $(VENV)/.installed
	$(BIN)/tethership dock --out out
	@echo
	@echo "Open next:"
	@echo "  out/replay.html              the flight in space, to be played, with its histories"
	@echo "  out/docking.png              the paper's four panels"
	@echo "  $(BIN)/tethership explore    a local page: change the wind, the cable or a gain and see what follows"

test: $(VENV)/.installed-dev
	$(BIN)/python -m pytest -n 2 --dist worksteal -m "not slow"

test-all: $(VENV)/.installed-dev
	$(BIN)/python -m pytest -n 2 --dist worksteal

lint: $(VENV)/.installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/basedpyright
	$(BIN)/lint-imports
	$(BIN)/codespell

docs: $(VENV)/.installed-dev
	$(BIN)/python -m sphinx -W --keep-going -q -b html docs out/docs
	@echo "open out/docs/index.html"

gallery: $(VENV)/.installed-dev
	for example in examples/*.py; do $(BIN)/python $$example || exit 1; cp out/$$(basename $$example .py).png docs/gallery/; done

bench: $(VENV)/.installed-dev
	$(BIN)/python benchmarks/cable.py
	$(BIN)/python benchmarks/docking.py
	$(BIN)/python benchmarks/linear.py
	$(BIN)/python benchmarks/batch.py
	$(BIN)/python benchmarks/campaign.py
	$(BIN)/python benchmarks/replay.py # needs Chromium
	$(BIN)/python benchmarks/waiting.py # its last rows need Chromium

figures: $(VENV)/.installed-dev
	$(BIN)/tethership dock --wind 12 --layers rewind,heading --out out/readme
	cp out/readme/docking.png docs/docking.png
	$(BIN)/python docs/make_replay_picture.py out/readme/replay.html docs/replay.png # needs Chromium, playwright
	$(BIN)/tethership sweep --over wind=6:12:13 --out out/readme
	cp out/readme/root_locus.png docs/root_locus.png
	@$(BIN)/python -c 'import playwright' 2>/dev/null && $(BIN)/python docs/make_explorer.py || echo 'no Playwright: docs/explorer.png is left as it is'

validation: $(VENV)/.installed
	$(BIN)/python docs/validation/make_linear.py
	$(BIN)/tethership reproduce --out out/reproduction
	$(BIN)/python docs/validation/make_docking.py out/reproduction

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "tethership needs Python 3.11 or newer; set PYTHON=/path/to/python3.11"; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: $(VENV)/bin/python pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[explore,reproduce]" || \
	  $(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[explore]"
	@touch $@

$(VENV)/.installed-dev: $(VENV)/bin/python pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e ".[dev]"
	@touch $(VENV)/.installed $@

clean:
	rm -rf $(VENV) out build dist
