#!/usr/bin/env bash
# Makes Debian packages of this checkout for this machine's release and its ParaView.
#
#   package.sh [FOLDER]     e.g. package.sh, then: apt install ./build/packages/*.deb
#
#   FOLDER   where the packages come to lie; build/packages if none is named
#
#   paraview-banyan   the plugin: ParaView lists it by itself
#   banyan-tools      banyan-info, banyan-verify and banyan-generate
#   libbanyan-dev     for C++ programs: find_package(Banyan)
#
# Installs what is missing, builds what git knows of in FOLDER/source, and checks the packages with lintian.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

case "${1:-}" in
  --help) sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; exit 0 ;;
  -*) fail "'$1' is not an option." ;;
esac
folder="$(realpath -m "${1:-$BuildFolder/packages}")"
cd "$RepositoryRoot"

stage 1 3 "Installing the packages that are missing"
[[ "${BANYAN_SKIP_INSTALL:-0}" == 1 ]] || Utilities/install-dependencies.sh --with-packaging

stage 2 3 "Building the packages"
source="$folder/source"
rm -rf "$source" "$folder"/*.deb
mkdir -p "$source"
git ls-files -z --cached --others --exclude-standard | tar --create --null --files-from=- | tar --extract --directory="$source"
cp -a Utilities/package "$source/debian"
sed '1,/^$/d; s/^$/./; s/^/ /' LICENSE >>"$source/debian/copyright"
version="$(sed -n 's/^project(Banyan VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)"
paraview="$(dpkg-query -W -f '${source:Upstream-Version}' paraview | cut -d . -f 1,2)"
maintainer="$(sed -n 's/^Maintainer: //p' Utilities/package/control)"
cat >"$source/debian/changelog" <<END
banyan ($version+paraview$paraview) UNRELEASED; urgency=medium

  * CHANGELOG.md tells what is new.

 -- $maintainer  $(git log -1 --format=%cD 2>/dev/null || date -R)
END
export CCACHE_DIR="${CCACHE_DIR:-$HOME/.cache/ccache}"
(cd "$source" && DEB_BUILD_OPTIONS="parallel=$(jobs_for_memory 1500)" dpkg-buildpackage -b -d -us -uc >&2) ||
  fail "the packages could not be built; the messages above say why."

stage 3 3 "Checking the packages"
lintian --fail-on error,warning "$folder"/*.changes >&2 || fail "lintian finds faults in the packages."
ls "$folder"/*.deb
