#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# mark.sh FOLDER URL KEY-ID ID: marks all GLB and PLY files of FOLDER over HTTP into FOLDER/marked and reads them back.
set -euo pipefail
[ $# = 4 ] || { echo "usage: mark.sh FOLDER URL KEY-ID ID" >&2; exit 2; }
folder=$1 url=$2 key=$3 id=$4
mkdir -p "$folder/marked"

# post PATH OUTPUT CURL-ARGUMENTS...: 0 on success; 503 is tried again, as Retry-After says.
post() {
  local path=$1 output=$2
  shift 2
  curl --silent --show-error --fail-with-body --retry 5 --header "quadmark-key: $key" --output "$output" "$@" "$url/v1/$path"
}

failed=0
shopt -s nullglob
for model in "$folder"/*.glb "$folder"/*.ply; do
  name=$(basename "$model")
  marked=$folder/marked/$name
  # To a temporary name first: a failure's JSON must not look like a model.
  if ! post embed "$marked.part" --form model="@$model" --form id="$id"; then
    echo "$name: not marked: $(cat "$marked.part")" >&2
    rm -f "$marked.part"
    failed=1
    continue
  fi
  mv "$marked.part" "$marked"
  post extract "$marked.json" --form model="@$marked" --form expectId="$id"
  grep -q '"verdict":"match"' "$marked.json" || { echo "$name: the mark was not read back" >&2; failed=1; }
  echo "$name: marked"
done
exit $failed
