# Front doors of casepush. `make help` lists them.
SHELL := /bin/sh
SOURCE := $(CURDIR)
CACHE ?= $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/casepush
# The build lives outside of the source tree: rosrun and roslaunch search all of the package folder.
BUILD ?= $(CACHE)/build-$(shell printf '%s' "$(SOURCE)" | cksum | cut -d' ' -f1)
JOBS ?= $(shell nproc)

# Arguments of `make demo`.
OBJECT ?= office_chair
WORLD ?= office
GOAL ?=
SEED ?= 1
GUI ?= false
RESULTS ?= $(SOURCE)/results/demo

export ROS_HOSTNAME ?= localhost
export PYTHONNOUSERSITE := 1

.PHONY: help deps configure build test demo setup clean

help:
	@echo "make demo    install, build, learn a chair and push it through a furnished room"
	@echo "             OBJECT=$(OBJECT) WORLD=$(WORLD) GOAL='x_m y_m yaw_deg' SEED=$(SEED) GUI=$(GUI)"
	@echo "make test    install, build and run every test"
	@echo "make build   install and build only; the build is in $(BUILD)"
	@echo "make setup   print the file to source for a shell of your own: . \"\$$(make -s setup)\""
	@echo "make clean   remove the build"

deps:
	@scripts/install_dependencies.sh

configure: deps
	@cmake -G Ninja -DCMAKE_BUILD_TYPE=Release -DCATKIN_ENABLE_TESTING=ON \
	  -S $(SOURCE) -B $(BUILD) > $(BUILD).log 2>&1 || { cat $(BUILD).log; exit 1; }

$(CACHE):
	@mkdir -p $(CACHE)

configure: | $(CACHE)

build: configure
	@ninja -C $(BUILD) -j $(JOBS)

test: build
	@cd $(BUILD) && ctest -j $(JOBS) --output-on-failure --no-tests=error

demo: build
	@. $(BUILD)/devel/setup.sh && scripts/run_demo --object "$(OBJECT)" --world "$(WORLD)" \
	  --goal "$(GOAL)" --seed "$(SEED)" --gui "$(GUI)" --results "$(RESULTS)"

setup:
	@echo $(BUILD)/devel/setup.sh

clean:
	rm -rf "$(BUILD)" "$(BUILD).log"
