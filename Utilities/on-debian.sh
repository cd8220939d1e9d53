#!/usr/bin/env bash
# Runs a command of the project on another release of Debian, which lies in a folder of its own.
#
#   on-debian.sh 12|13|testing [--bare] COMMAND...    e.g. on-debian.sh 13 Utilities/test.sh
#   on-debian.sh 12|13|testing --remove
#
#   --bare     the command sees the bare release, without any package that was installed there before,
#              and what it changes is gone afterwards (but for the project's own folder)
#   --remove   removes the release's folder; the next command makes it anew, with today's packages
#
# The first command makes the release with debootstrap, from the mirror that this machine's apt uses. It is
# kept in ~/.cache/banyan (BANYAN_DEBIAN names another folder) with the packages that commands install.
# The project is the same folder there as here, and so is that of real data (BANYAN_DATA_DIR, or ../shared/data),
# which can only be read. The build is in build-debian-RELEASE (BANYAN_BUILD_DIR names another). Needs root, and
# the package debootstrap. On another machine, make such a folder with `debootstrap --variant=minbase SUITE
# FOLDER`, bind /dev, /sys, /proc and the project, and chroot.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# SPDX-License-Identifier: BSD-3-Clause

help()
{
  sed -n '2,/^source/{/^source/d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"
}

case "${1:-}" in
  12) suite=bookworm ;;
  13) suite=trixie ;;
  testing) suite=testing ;;
  --help) help; exit 0 ;;
  "") help >&2; exit 2 ;;
  *) fail "'$1' is none of the releases 12, 13 and testing." ;;
esac
release="$1"
folder="${BANYAN_DEBIAN:-$HOME/.cache/banyan}/debian-$release"
shift
[[ $# -gt 0 ]] || fail "a command to run on Debian $release is missing."
[[ "$(id -u)" == 0 ]] || fail "only root can enter another release."

if [[ "$1" == --remove ]]; then
  rm -rf --one-file-system "$folder"
  exit 0
fi

# The address of the first mirror of Debian's main packages that apt knows.
mirror()
{
  apt-get indextargets --format '$(ORIGIN) $(COMPONENT) $(LABEL) $(REPO_URI)' 'Created-By: Packages' |
    awk '$1 == "Debian" && $2 == "main" && $3 == "Debian" { print $4; exit }'
}

# Makes $folder/base, all of it or nothing.
make_base()
{
  local address
  command -v debootstrap >/dev/null || fail "debootstrap is missing: apt-get install debootstrap."
  address="$(mirror)"
  [[ -n "$address" ]] || fail "apt on this machine knows no mirror of Debian; apt-get update may help."
  say "Making Debian $release in $folder"
  rm -rf --one-file-system "$folder.new"
  mkdir -p "$folder.new"
  # A mirror may be an older copy, and the list of packages of testing is valid for a week only.
  debootstrap --variant=minbase "$suite" "$folder.new/base" "$address" >"$folder.new/log" 2>&1 ||
    fail "debootstrap could not make it; the last lines of $folder.new/log say why."
  [[ "$suite" != testing ]] ||
    echo 'Acquire::Check-Valid-Until "false";' >"$folder.new/base/etc/apt/apt.conf.d/90old-mirror"
  rm -rf --one-file-system "$folder"
  mv "$folder.new" "$folder"
}

[[ -d "$folder/base" ]] || make_base
root="$folder/root"
if [[ "$1" == --bare ]]; then
  shift
  root="$(mktemp -d "$folder/bare.XXXXXX")"
  trap 'rm -rf --one-file-system "$root"' EXIT
  cp -a "$folder/base/." "$root"
elif [[ ! -d "$root" ]]; then
  rm -rf --one-file-system "$root.new"
  cp -a "$folder/base" "$root.new"
  mv "$root.new" "$root"
fi
[[ $# -gt 0 ]] || fail "a command to run on Debian $release is missing."
data="$(realpath -m "${BANYAN_DATA_DIR:-$RepositoryRoot/../shared/data}")"
mkdir -p "$root$RepositoryRoot"
[[ ! -d "$data" ]] || mkdir -p "$root$data"
cp -L /etc/resolv.conf /etc/hosts "$root/etc/"

# Runs in a mount and a process namespace of its own: what is bound and started here ends with it.
enter()
{
  local root="$1" repository="$2" data="$3"
  shift 3
  mount --rbind /dev "$root/dev"
  mount --rbind /sys "$root/sys"
  mount -t proc proc "$root/proc"
  mount --bind "$repository" "$root$repository"
  [[ ! -d "$data" ]] || mount --bind --options ro "$data" "$root$data"
  exec chroot "$root" env -i "HOME=/root" "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin" \
    LANG=C.UTF-8 "TERM=${TERM:-dumb}" "${passed[@]}" \
    bash -c 'cd "$0" && exec "$@"' "$repository" "$@"
}

export BANYAN_BUILD_DIR="${BANYAN_BUILD_DIR:-$RepositoryRoot/build-debian-$release}"
mapfile -t passed < <(env | grep '^BANYAN_' | grep -v '^BANYAN_DEBIAN=')
unshare --mount --pid --fork --kill-child \
  bash -ec "$(declare -f enter); $(declare -p passed); enter \"\$@\"" enter "$root" "$RepositoryRoot" "$data" "$@"
