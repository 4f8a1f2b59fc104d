# Everything from a bare clone: each command first makes what it needs (.venv, build, install).

SHELL := bash
.DEFAULT_GOAL := help
.PHONY: help demo report test bench fuzz soak pictures lint build shell lock clean
run := bash scripts/run.sh

# ROBOT, VIEW, PYTHON and ROS (a release of ROS 2) reach the scripts through the environment.

help: ## This list
	@sed -n 's/^\([a-z]*\):.*## /\1\t/p' Makefile | expand -t 12

demo: ## A simulated arm held by the node; ROBOT=path.urdf: another robot, VIEW=1: in a window
	@$(run) demo python -m dynamics_node.demo $(if $(ROBOT),--robot "$(ROBOT)") \
	$(if $(filter-out 0 no false,$(VIEW)),--view)

report: ## What a URDF contains, and what is wrong with it: ROBOT=path.urdf; ARGS='...': see ARGS=--help
	@$(run) demo python -m dynamics_node.report "$(or $(ROBOT),config/robots/arm7.urdf)" $(ARGS)

test: ## All tests; ROS=kilted: those that need ROS 2, on Kilted; ARGS='...': arguments of pytest
	@bash scripts/test.sh $(ARGS)

bench: ## Speed beside other libraries, into docs/benchmarks.md; ARGS='...': see python -m benchmarks -h
	@$(run) bench python -m benchmarks $(ARGS)

fuzz: ## 100 000 broken descriptions and joint states; ARGS='...': see python -m fuzz -h
	@$(run) test python -m fuzz $(ARGS) || { code=$$?; ((code <= 128)) || \
	echo "signal $$((code - 128)) ended the process; its last input: make fuzz ARGS='--replay log/fuzz/running...'"; exit $$code; }

soak: ## The simulated arm for 10 minutes, faults at random; ARGS='...': see python -m soak -h
	@$(run) demo python -m soak $(ARGS)

pictures: ## Draw the pictures of the documents; ARGS='...': only some, see scripts/make_pictures.py
	@$(run) demo python scripts/make_pictures.py $(ARGS)

lint: ## ruff and mypy
	@$(run) test bash -c 'ruff check . && ruff format --check . && codespell && python -m mypy dynamics_node benchmarks'

build: ## Install what is missing and build both packages with colcon
	@$(run) demo echo 'Built. Next: make demo, make test or make shell.'

shell: ## A bash in which the packages are active
	@bash scripts/shell.sh

lock: ## Newer versions of the packages, into uv.lock
	@bash scripts/setup.sh lock

clean: ## Remove everything that make has made
	@bash scripts/clean.sh
