# Everything from a bare clone: each command first makes what it needs (.venv, build, install).

SHELL := bash
.DEFAULT_GOAL := help
.PHONY: help demo report test bench fuzz soak pictures lint build shell lock clean

# ROBOT, VIEW, PYTHON and ROS (a release of ROS 2) reach the scripts through the environment.

help: ## This list
	@sed -n 's/^\([a-z]*\):.*## /\1\t/p' Makefile | expand -t 8

demo: ## A simulated arm held by the node; ROBOT=path.urdf: another robot, VIEW=1: in a window
	@bash scripts/demo.sh

report: ## What a URDF says, and what is wrong with it: ROBOT=path.urdf; ARGS='...': see ARGS=--help
	@bash scripts/report.sh $(ARGS)

test: ## All tests; ROS=kilted: those that need ROS 2, on Kilted; ARGS='...': arguments of pytest
	@bash scripts/test.sh $(ARGS)

bench: ## Speed beside other libraries, into docs/benchmarks.md; ARGS='...': see python -m benchmarks -h
	@bash scripts/bench.sh $(ARGS)

fuzz: ## 100 000 broken descriptions and joint states; ARGS='...': see python -m fuzz -h
	@bash scripts/fuzz.sh $(ARGS)

soak: ## The simulated arm for 10 minutes, faults at random; ARGS='...': see python -m soak -h
	@bash scripts/soak.sh $(ARGS)

pictures: ## Draw the pictures of the documents; ARGS='...': only some, see scripts/make_pictures.py
	@bash scripts/pictures.sh $(ARGS)

lint: ## ruff and mypy
	@bash scripts/lint.sh

build: ## Install what is missing and build both packages with colcon
	@bash scripts/build.sh

shell: ## A bash in which the packages are active
	@bash scripts/shell.sh

lock: ## Renew the pinned versions in requirements/lock (needs Python 3.10 to 3.13)
	@bash scripts/lock.sh

clean: ## Remove everything that make has made
	@bash scripts/clean.sh
