# `make demo` and `make test` do everything on a machine that has only Python 3.11 or 3.13:
#     make demo PYTHON=/path/to/python3.11
PYTHON ?= python3
VENV ?= .venv
REQUIREMENTS ?= requirements.txt
SAMPLE ?= sphere
DEMO ?= demo
REPORT ?= report
BUDGET ?= 10
GROWTH ?= 7
SECONDS ?= 600

BLENDER ?= $(if $(wildcard $(VIRTUAL_SCREEN)),$(VIRTUAL_SCREEN) run -t 600)
VIRTUAL_SCREEN ?= ../shared/blender-gui/blender-gui
WINDOW_TESTS = tests/window/ways_in.py tests/window/clicks.py tests/window/repeated.py tests/window/light_at_work.py \
               tests/window/drop.py tests/window/live.py

RUN = $(VENV)/bin/python
READY = $(VENV)/.ready
VIEWER = build/viewer
THREE = $(VIEWER)/node_modules/three/package.json

.DEFAULT_GOAL := help
.PHONY: help environment demo measure report report-plots numerics rate work pictures \
        test test-all lint test-core test-addon test-addon-slow test-addon-rest test-window viewer live-picture window-pictures fuzz zip samples clean

help:
	@echo "make demo     the main job on a sample (SAMPLE=$(SAMPLE)): pictures and numbers in $(DEMO)/ (VERBOSE=1: Cycles' log)"
	@echo "make test     style and types, and at least one test of every feature, operator and verb: 6 minutes on two cores"
	@echo "make test-all every test: 40 minutes on two cores "
	@echo "make test-core, make test-addon   the method's or the extension's tests (ONLY='not slow', ONLY=thorough ...: a part)"
	@echo "make test-window  keys and buttons pressed in a real window (BLENDER=/path/to/blender, a display): pictures in build/window/"
	@echo "make fuzz     a search for failures at random, for SECONDS=$(SECONDS), from new seeds or from FIRST=..."
	@echo "make measure  one table of errors and times over all samples (SAMPLES='sphere water' for some)"
	@echo "make report   every method's error and seconds on all samples, judged by Cycles: one report in $(REPORT)/"
	@echo "make report-plots  the tables of docs/benchmark.md from that report, and its plots in docs/benchmark/"
	@echo "make numerics the table and the plot of docs/numerics.md: the solver against exact arithmetic"
	@echo "make rate     pairs a second: the solver beside the plain closed form, in one run"
	@echo "make work     what each method counts on the setting of the talk's cost model"
	@echo "make zip      the extension as a zip in dist/, to install in Blender"
	@echo "make pictures the pictures of the documents, in docs/pictures/"
	@echo "make live-picture  the picture of Live, docs/pictures/live.gif, made in a window as test-window is"
	@echo "make window-pictures  the documents' pictures of panels, menus and progress, made in a window too"
	@echo "make samples  write sample_blends/*.blend anew"
	@echo "PYTHON=... chooses the Python, 3.11 or 3.13 (now: $(PYTHON))"

environment: $(READY)

$(READY): $(REQUIREMENTS)
	@command -v "$(PYTHON)" >/dev/null 2>&1 && "$(PYTHON)" -c '' >/dev/null 2>&1 || { \
	  echo "There is no working Python called '$(PYTHON)': install Python 3.11 or 3.13, or name one with PYTHON=/path/to/python." >&2; exit 1; }
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info[:2] not in ((3, 11), (3, 13)))' || { \
	  echo "'$(PYTHON)' is $$("$(PYTHON)" -V 2>&1), but bpy exists for Python 3.11 and 3.13 only: name one of them with PYTHON=/path/to/python." >&2; exit 1; }
	@[ ! -e "$(VENV)" ] || [ -e "$(VENV)/.ready" ] || [ -e "$(VENV)/.unready" ] || { \
	  echo "'$(VENV)' exists and is not an environment of this Makefile, which would delete it: name another one with VENV=." >&2; exit 1; }
	@rm -rf "$(VENV)"
	@"$(PYTHON)" -m venv "$(VENV)" || { \
	  echo "'$(PYTHON)' cannot make an environment: install its module venv (on Debian: apt-get install python3-venv)." >&2; exit 1; }
	@touch "$(VENV)/.unready"
	$(RUN) -m pip install --quiet --disable-pip-version-check -r $(REQUIREMENTS)
	@if grep -q '^bpy' $(REQUIREMENTS); then $(RUN) -c 'import bpy' || { \
	  echo "bpy needs libraries of the system (on Debian: apt-get install $$(tr '\n' ' ' < requirements-system.txt))." >&2; exit 1; }; fi
	@touch $@

demo: environment
	$(RUN) -m tools.demo --sample $(SAMPLE) --folder $(DEMO) $(if $(VERBOSE),--verbose)

measure: environment
	$(RUN) -m tools.measure $(SAMPLES)

report: environment
	$(RUN) addon/run_with_bpy.py $(sort $(wildcard sample_blends/*.blend)) benchmark --output $(REPORT) \
	  --budget $(BUDGET) --growth $(GROWTH)

report-plots: environment
	$(RUN) -m tools.read_report $(REPORT)

numerics: environment
	$(RUN) -m tools.solver.numerics

rate: environment
	$(RUN) -m tools.solver.solver_rate

work: environment
	$(RUN) -m tools.work

pictures: environment
	$(RUN) -m tools.pictures.samples
	$(RUN) -m tools.pictures.lines
	$(RUN) -m tools.pictures.caustics
	$(RUN) -m tools.pictures.manual
	$(RUN) -m tools.pictures.animation
	$(RUN) -m tools.pictures.parts
	$(RUN) -m tools.pictures.stained
	$(RUN) -m tools.pictures.anamorphosis
	$(RUN) -m tools.pictures.cameras
	$(RUN) -m tools.pictures.tutorials

# Two at a time, since most of a test is Python's, on one core. What each prints follows when it is done, where make can
# hold it back (GNU make 4).
QUICK = not slow and not thorough
TWO_AT_A_TIME = $(MAKE) --no-print-directory -j2 --keep-going $(if $(filter output-sync,$(.FEATURES)),--output-sync=target)

test: environment
	@echo "About 6 minutes on two cores; each part's results follow when it is done."
	@$(TWO_AT_A_TIME) test-addon lint test-core ONLY="$(QUICK)" COVER=--every-feature

test-all: environment viewer
	@$(TWO_AT_A_TIME) test-addon-slow test-addon-rest test-core lint

lint: environment
	$(RUN) -m ruff check .
	$(RUN) -m mypy

test-core: environment
	$(RUN) -m pytest -q $(if $(ONLY),-m "$(ONLY)") tests/core tests/fuzz

test-addon test-addon-slow test-addon-rest: environment
	$(RUN) -m pytest -q $(if $(ONLY),-m "$(ONLY)") $(COVER) tests/addon

# three.js, which shows exported files in Chromium: tests of that are skipped where either is missing
viewer:
	@[ -e $(THREE) ] || ! command -v npm > /dev/null || { mkdir -p $(VIEWER) && \
	  cp $(addprefix tests/addon/exports/viewer/,package.json package-lock.json .npmrc) $(VIEWER) && \
	  cd $(VIEWER) && npm ci --no-audit --no-fund --loglevel=error; } || true
	@[ -e $(THREE) ] || echo "Exported files are NOT shown by three.js: that needs npm and Chromium (on Debian: apt-get install npm chromium)."

test-addon-slow: ONLY = slow
test-addon-rest: ONLY = not slow

# BLENDER may be more than one word: a driver of a virtual screen, and its options
test-window:
	@if [ -z "$(BLENDER)" ]; then \
	  echo "test-window was NOT run: it needs a Blender with a window, as BLENDER=/path/to/blender."; \
	else \
	  for script in $(WINDOW_TESTS); do \
	    echo "== $$script"; \
	    BLENDER_USER_RESOURCES=$$(mktemp -d) $(BLENDER) --enable-event-simulate --python $$script || exit 1; \
	  done; \
	fi

live-picture:
	BLENDER_USER_RESOURCES=$$(mktemp -d) $(BLENDER) --enable-event-simulate --python tools/live_picture.py

window-pictures:
	BLENDER_USER_RESOURCES=$$(mktemp -d) $(BLENDER) --enable-event-simulate --python tools/window_pictures.py

fuzz: environment
	$(RUN) -m tests.fuzz --seconds $(SECONDS) $(if $(FIRST),--first $(FIRST))

# Python's own modules suffice: no environment is made
zip:
	@"$(PYTHON)" -m tools.extension_zip dist

samples: environment
	$(RUN) sample_blends/make_samples.py

clean:
	rm -rf .venv* build dist $(DEMO) $(REPORT)
