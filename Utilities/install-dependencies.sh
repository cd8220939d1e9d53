#!/usr/bin/env bash
# Installs the Debian packages that Banyan is built, tested and demonstrated with.
#   install-dependencies.sh          installs those that are missing (as root, or through sudo)
#   install-dependencies.sh --list   prints their names
#   install-dependencies.sh --list-development   only those that programs in C++ need
#   install-dependencies.sh --with-checks  also what Utilities/check-style.sh needs
#   install-dependencies.sh --with-packaging  also what Utilities/package.sh needs
#   install-dependencies.sh --with-peers   also the codecs and the network simulator of Benchmarks
# Does nothing, and needs neither root nor network, when all are there.
# SPDX-License-Identifier: BSD-3-Clause
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

Packages=(
  # Compiler and build tools
  g++ cmake ninja-build ccache pkg-config
  # Libraries of Core, the generator, the tests and the benchmarks
  libzstd-dev libxxhash-dev nlohmann-json3-dev libhwy-dev libfftw3-dev
  libnetcdf-dev libgtest-dev libbenchmark-dev
  # To run: ranks, a display, pictures and animations
  python3-paraview openmpi-bin xvfb xauth ffmpeg imagemagick openbox
  python3-numpy python3-matplotlib
)

# What find_package(Banyan) needs: ParaView, and what its CMake package looks for but does not depend on.
DevelopmentPackages=(
  libglm-dev paraview-dev libopenmpi-dev
  libxml2-dev libhdf5-openmpi-dev libutfcpp-dev libogg-dev libtheora-dev
  libavcodec-dev libavformat-dev libavutil-dev libswscale-dev libswresample-dev libgl2ps-dev
  libpng-dev libgdal-dev libglew-dev libdouble-conversion-dev libfreetype-dev
)

# Qt of Debian 12's ParaView, and of newer ones.
Qt5Packages=(
  qtbase5-dev qttools5-dev libqt5svg5-dev libqt5opengl5-dev libqt5x11extras5-dev qtxmlpatterns5-dev-tools
)
Qt6Packages=(qt6-base-dev qt6-tools-dev qt6-svg-dev qt6-5compat-dev xsltproc python3-dev)

PeerPackages=(libsimgrid-dev libzfp-dev libblosc-dev libopenvdb-dev libnanovdb-dev libimath-dev libtbb-dev)

PackagingPackages=(debhelper git help2man lintian)

CheckPackages=(clang-format clang-tidy codespell)

as_root=()
apt_get()
{
  if [[ "$(id -u)" != 0 ]]; then
    command -v sudo >/dev/null ||
      fail "packages are missing and only root can install them; run this script as root."
    as_root=(sudo)
  fi
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 "$@" >&2
}

# Names of the packages that ParaView needs: of the one that is installed, or else the one that would be.
needs_of_paraview()
{
  dpkg-query -W -f '${Depends}' paraview 2>/dev/null || apt-cache depends paraview 2>/dev/null || true
}

needs="$(needs_of_paraview)"
if [[ -z "$needs" && "${1:-}" != --list* ]] && command -v apt-get >/dev/null; then
  apt_get update || true
  needs="$(needs_of_paraview)"
fi
if [[ "$needs" == *libqt5* ]]; then
  DevelopmentPackages+=("${Qt5Packages[@]}")
else
  DevelopmentPackages+=("${Qt6Packages[@]}")
  Packages+=(qt6-svg-plugins) # icons of the window
fi
# Since ParaView 6, Debian builds it with VTK's own packages.
[[ "$needs" != *libvtk9* ]] || DevelopmentPackages+=(libvtk9-dev)
Packages+=(paraview "${DevelopmentPackages[@]}")

case "${1:-}" in
  "") ;;
  --with-checks) Packages+=("${CheckPackages[@]}") ;;
  --with-peers) Packages+=("${PeerPackages[@]}") ;;
  --with-packaging) Packages+=("${PackagingPackages[@]}") ;;
  --list-development) printf '%s\n' "${DevelopmentPackages[@]}"; exit 0 ;;
  --list) printf '%s\n' "${Packages[@]}"; exit 0 ;;
  *) sed -n '2,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  fail "packages can be installed on Debian only: install the equivalents of" \
    "'install-dependencies.sh --list' yourself and set BANYAN_SKIP_INSTALL=1."
fi

# A package counts as present when dpkg says "installed", not when only its settings remain.
installed="$(dpkg-query -W -f '${binary:Package} ${db:Status-Status}\n' 2>/dev/null |
  awk '$2 == "installed" { sub(/:.*/, "", $1); print $1 }')"
missing=()
for package in "${Packages[@]}"; do
  grep -qxF -- "$package" <<<"$installed" || missing+=("$package")
done
if [[ ${#missing[@]} == 0 ]]; then
  say "All ${#Packages[@]} packages are installed."
  exit 0
fi

say "Installing ${#missing[@]} packages: ${missing[*]}"
apt_get update || say "The package lists could not be refreshed; trying with those that are there."
apt_get install -y --no-install-recommends "${missing[@]}" ||
  fail "apt-get could not install the packages; its own messages above say why."
