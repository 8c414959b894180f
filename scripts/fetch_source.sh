#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# fetch_source.sh PACKAGE DIRECTORY ORIG_TARBALL SHA256
# Fetches the original source of a distribution package by apt, checks it and unpacks it, without touching the
# machine's own apt configuration: source entries are derived from its binary ones into a private list.
# Another release of the distribution may have another version than ORIG_TARBALL: that one is taken on apt's own
# signature check alone, and said so.
set -euo pipefail
package=$1 directory=$2 tarball=$3 sha256=$4
fail() { printf 'fetch_source: error: %s\n' "$*" >&2; exit 1; }

work=$(mktemp -d "$(dirname "$directory")/source.XXXXXX")
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/lists/partial" "$work/parts" "$work/archives/partial"

# One-line entries, then deb822 ones. Options in brackets (signed-by, arch) are kept, but no source is of one architecture.
shopt -s nullglob
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
  [ -f "$list" ] && sed -nE 's/^[[:space:]]*deb[[:space:]]+/deb-src /p' "$list" | sed -E 's/arch=[^] ]*//' >>"$work/sources.list"
done
touch "$work/sources.list"
for list in /etc/apt/sources.list.d/*.sources; do
  sed -E 's/^Types:.*/Types: deb-src/; /^Architectures:/d' "$list" >"$work/parts/$(basename "$list")"
done

options=(-o "Dir::Etc::sourcelist=$work/sources.list" -o "Dir::Etc::sourceparts=$work/parts"
         -o "Dir::State::lists=$work/lists" -o "Dir::Cache::archives=$work/archives"
         -o "Dir::Cache::pkgcache=" -o "Dir::Cache::srcpkgcache=" -o "APT::Sandbox::User=root"
         -o "APT::Get::List-Cleanup=0")
apt-get "${options[@]}" update -qq >"$work/log" 2>&1 || echo "fetch_source: warning: some package lists failed" >&2
(cd "$work" && apt-get "${options[@]}" source --download-only -qq "$package" >>log 2>&1) ||
  { tail -n 5 "$work/log" >&2; fail "apt-get source $package failed"; }

if [ -f "$work/$tarball" ]; then
  echo "$sha256  $work/$tarball" | sha256sum --check --quiet || fail "$tarball: wrong checksum"
else
  tarball=$(cd "$work" && ls -- "$package"_*.orig.tar.* | head -n 1) || fail "$package: apt fetched no original source"
  echo "fetch_source: this distribution has $tarball, checked by apt's signature only" >&2
fi
mkdir "$work/unpacked"
tar -xf "$work/$tarball" -C "$work/unpacked" --strip-components=1
rm -rf "$directory"
mv "$work/unpacked" "$directory"
