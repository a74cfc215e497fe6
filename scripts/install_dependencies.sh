#!/bin/sh
# Installs what casepush needs from Debian's packages; does nothing if all is there.
set -eu

packages="
  build-essential ccache cmake git ninja-build pkg-config
  catkin ros-desktop-full-dev rosbash librviz-dev librostest-dev libactionlib-dev
  libdiagnostic-updater-dev libmessage-filters-dev libtf2-ros-dev
  libboost-dev libbullet-dev libcli11-dev libeigen3-dev libfcl-dev libgtest-dev liboctomap-dev
  libompl-dev librapidcheck-dev libsqlite3-dev liburdfdom-dev libyaml-cpp-dev nlohmann-json3-dev
  python3 python3-jinja2 python3-matplotlib python3-numpy python3-pil python3-pytest
  python3-diagnostic-msgs python3-nav-msgs python3-rosbag python3-rostest python3-std-srvs
  python3-visualization-msgs python3-yaml
"

if ! command -v apt-get >/dev/null 2>&1; then
  echo "casepush: apt-get not found; install the packages listed in $0 by other means" >&2
  exit 1
fi
missing=""
for package in $packages; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
    missing="$missing $package"
done
if [ -z "$missing" ]; then
  exit 0
fi
echo "casepush: installing$missing"
run=""
if [ "$(id -u)" != 0 ]; then
  run="sudo"
fi
$run apt-get update -qq
# shellcheck disable=SC2086
DEBIAN_FRONTEND=noninteractive $run apt-get install -y -qq --no-install-recommends $missing
