#!/usr/bin/env bash
# Everything that a release publishes, into dist/: packaging/release.sh v1.2.3. Nothing leaves this machine.
# It needs Node.js and packaging/requirements-release.txt.
set -euo pipefail
cd "$(dirname "$0")/.."
tag=${1:?name a tag, v1.2.3}
version=${tag#v}
python=${PYTHON:-python}
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct "$tag^{commit}")
export SOURCE_DATE_EPOCH

[ -z "$(git status --porcelain)" ] || { echo "the tree has changes: commit them first"; exit 1; }
[ "$(git describe --exact-match --tags HEAD)" = "$tag" ] || { echo "HEAD is not $tag"; exit 1; }
grep -q "\"version\": \"$version\"" web/eigenfield-three/package.json || { echo "web/eigenfield-three/package.json is not $version"; exit 1; }
rm -rf dist
mkdir -p dist/python dist/npm dist/beside dist/again

echo "== notes"
awk -v head="## [$version]" 'index($0, head) == 1 { on = 1; next } /^## / { on = 0 } on' CHANGELOG.md > dist/beside/notes.md
grep -q . dist/beside/notes.md || { echo "CHANGELOG.md has no section [$version]"; exit 1; }

echo "== wheel and sdist, twice"
for place in python again; do
  "$python" -m build --no-isolation --outdir "dist/$place" > "dist/$place.log"
done
(cd dist/python && sha256sum -- *) | tee dist/beside/SHA256SUMS
(cd dist/again && sha256sum --check --quiet ../beside/SHA256SUMS)
ls "dist/python/eigenfield-$version.tar.gz" "dist/python/eigenfield-$version-py3-none-any.whl"

echo "== used elsewhere, with the bill of materials of all that comes along"
"$python" packaging/try_wheel.py dist/python dist/beside/eigenfield.cdx.json

echo "== Blender add-on"
"$python" packaging/addon.py "dist/beside/eigenfield-blender-$version.zip" "$version"

echo "== viewer and plug-in, twice"
(cd web && npm ci --no-audit --no-fund --silent)
for place in npm again; do
  (cd web && npm run --silent build && npm pack --silent --workspace eigenfield-three --pack-destination "../dist/$place")
  git diff --exit-code --stat -- src/eigenfield/viewer/static
done
cmp dist/npm/*.tgz dist/again/*.tgz
(cd dist/npm && sha256sum -- *) >> dist/beside/SHA256SUMS
(cd dist/beside && sha256sum -- *.zip >> SHA256SUMS)

rm -rf dist/again dist/*.log
find dist -type f
