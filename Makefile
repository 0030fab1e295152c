# Everybody's commands. `make run` and `make test` are all a newcomer needs.
PYTHON ?= python3
unexport PYTHONDONTWRITEBYTECODE  # the tests start Python often, and 4 of them read the same tests
VENV   := .venv
BIN    := $(VENV)/bin
STAMP  := $(VENV)/.installed
QUIETLY := --quiet --disable-pip-version-check --no-compile
# uv takes 5 s where pip takes 40, and the environment needs no pip of its own: 3 s to make; where uv or a package
# cannot be had that way, a pip is put in and does the work
install = { $(PYTHON) -m pip --python $(BIN)/python install $(QUIETLY) uv \
	    && $(BIN)/uv pip install --quiet --python $(BIN)/python $(1); } \
	  || { $(PYTHON) -m venv $(VENV) && $(BIN)/python -m pip install $(QUIETLY) $(1); }

.PHONY: run test check lint types contracts bench fuzz mutants pictures recording soak dist docs help clean

help:  ## this list
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

run: $(STAMP)  ## install if needed, open the IDE with an example loaded
	$(BIN)/desire examples/ch1/step_response.src

test: $(STAMP)  ## install what the tests need and run them all
	$(BIN)/python -m pytest -n 3 --dist worksteal

check: $(STAMP) lint  ## lint + types + import contracts + tests
	@# tests wait for a part of their time: types and contracts use it, and report when the tests are over
	@$(MAKE) -s -k types contracts >$(VENV)/types-contracts.log 2>&1 & others=$$!; \
	$(MAKE) -s test; tests=$$?; \
	wait $$others; others=$$?; cat $(VENV)/types-contracts.log; \
	test $$tests$$others = 00

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(STAMP)
	$(BIN)/mypy

contracts: $(STAMP)
	$(BIN)/lint-imports

bench: $(STAMP)  ## every benchmark, each side by side with its yardstick
	$(BIN)/python -m benchmarks

SECONDS := 60
SEED := 1

fuzz: $(STAMP)  ## random inputs of every kind, SECONDS=60 of them; what failed is kept in fuzz-failures/
	$(BIN)/python -m tests.fuzz --seconds $(SECONDS) --seed $(SEED)

mutants: $(STAMP)  ## put deliberate faults into a copy of the engine and see which of them no test notices
	$(BIN)/python -m tests.mutants

recording: $(STAMP)  ## the moving picture in the README: the real program in a pseudo-terminal
	$(BIN)/python -m tests.app.recording

soak: $(STAMP)  ## edit and run at full speed for SECONDS; memory, threads and files must end as they began
	$(BIN)/python -m tests.soak $(SECONDS)

pictures: $(STAMP)  ## the screenshots in docs/
	$(BIN)/python -m tests.app.pictures

dist: $(STAMP)  ## build source archive and wheel in dist/, try the wheel in an empty folder
	$(BIN)/python -m tests.package

docs: $(STAMP)  ## the documentation as a site in site/, with a gallery of all examples
	$(call install,-e '.[docs]')
	PYTHONPATH=. NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet

clean:  ## remove the environment and caches
	rm -rf $(VENV) .pytest_cache .mypy_cache .ruff_cache

$(STAMP): pyproject.toml
	test -d $(VENV) || $(PYTHON) -m venv --without-pip $(VENV)
	$(call install,-e '.[dev]')
	@# pip compiles on one core, and an editable install leaves the package itself out: 0.3 s at the first start
	@# two fifths of all libraries are their own tests and what nobody imports here
	$(BIN)/python -m compileall -q -j 0 \
	  -x '/(tests?|pip|mypyc?|setuptools|pkg_resources|debugpy|lexers|jedi|prompt_toolkit|dataframe|distutils|dashboard|varLib|pydantic/v1|wcwidth/table_grapheme_overrides)/|/SALib/sample/directions' \
	  $(VENV)/lib desire_tui || true
	touch $(STAMP)
