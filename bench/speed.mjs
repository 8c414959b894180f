// SPDX-License-Identifier: MIT
// Speed and memory of embed and extract, natively and as wasm, on the same files: the table in docs/performance.md.
//
//   node bench/speed.mjs [--write] [--repeats N]     --write replaces the table in docs/performance.md
//
// Needs build/native (cmake --preset release) and the built package (scripts/setup.sh, cmake --preset wasm).
// Times vary with the machine and its load: compare within one run, read medians, trust ratios.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { cpus } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { createKey, embed, encodeImage, extract, inspect, version } from 'quadmark';
import { generate } from 'quadmark/lab';

const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const models = process.env.QUADMARK_MODELS ?? join(root, '../shared/models');
const { values: options } = parseArgs({ options: { write: { type: 'boolean' }, repeats: { type: 'string', default: '7' } } });
const repeats = Number(options.repeats);
const scratch = join(root, 'out/bench');
mkdirSync(scratch, { recursive: true });

function logo(side) {
  const bits = new Uint8Array(side * side);
  for (let y = 0; y < side; ++y) {
    for (let x = 0; x < side; ++x) {
      const r = Math.hypot(x + 0.5 - side / 2, y + 0.5 - side / 2) / side;
      bits[y * side + x] = (r < 0.46 && r > 0.34) || Math.abs(x - y) < side * 0.07 ? 1 : 0;
    }
  }
  return { width: side, height: side, bits };
}

async function wasmTimes(call) {
  const millis = [];
  await call();
  for (let i = 0; i < repeats; ++i) {
    const start = performance.now();
    await call();
    millis.push(performance.now() - start);
  }
  millis.sort((a, b) => a - b);
  return { medianMs: millis[millis.length >> 1], minMs: millis[0] };
}

const cases = [];
const bunny = join(models, 'bunny.glb');
if (existsSync(bunny)) cases.push({ name: 'bunny.glb', bytes: readFileSync(bunny) });
else console.error(`bunny.glb is not in ${models}: generated models only`);
for (const vertices of [35_000, 250_000, 1_000_000, 2_000_000]) {
  cases.push({ name: `sculpture, ${vertices.toLocaleString('en-US')}`, bytes: (await generate({ name: 'sculpture', vertices, format: 'glb' })).bytes });
}

const image = logo(24);
const schemes = {
  paper: { key: await createKey({ width: 24, height: 24 }), mark: { image }, argument: join(scratch, 'logo.png') },
  robust: { key: await createKey(), mark: { id: 'c0ffee' }, argument: 'c0ffee' },
};
const OPERATIONS = { embed: 'embed', extract: 'extract', search: 'extract, unmarked' };
writeFileSync(join(scratch, 'logo.png'), await encodeImage(image));

const rows = [];
for (const { name, bytes } of cases) {
  const path = join(scratch, 'model.glb');
  writeFileSync(path, bytes);
  for (const [scheme, { key, mark, argument }] of Object.entries(schemes)) {
    if (scheme === 'robust' && bytes.length > 50e6) continue;  // the same again in minutes
    writeFileSync(join(scratch, 'key.json'), JSON.stringify(key));
    const native = JSON.parse(execFileSync(join(root, 'build/native/bench/quadmark_speed'),
      [path, join(scratch, 'key.json'), argument, String(repeats)], { encoding: 'utf8' }));
    const { vertices } = await inspect(bytes);
    const marked = await embed(bytes, { key, ...mark });
    const read = await extract(marked.bytes, { key });
    if (read.verdict !== 'match') throw new Error(`${name}: verdict ${read.verdict}`);
    const wasm = {
      embed: await wasmTimes(() => embed(bytes, { key, ...mark })),
      extract: await wasmTimes(() => extract(marked.bytes, { key })),
      search: await wasmTimes(() => extract(bytes, { key })),
    };
    for (const [operation, title] of Object.entries(OPERATIONS)) {
      const n = native[operation], w = wasm[operation];
      const rate = (ms) => (vertices / ms / 1000).toFixed(2);
      rows.push([name, vertices.toLocaleString('en-US'), scheme, title, n.medianMs.toFixed(1), rate(n.medianMs), w.medianMs.toFixed(1),
        rate(w.medianMs), n.oneThreadMs.toFixed(1), (n.oneThreadMs / w.medianMs).toFixed(2), n.peakBytesPerVertex.toFixed(0)]);
      console.error(rows.at(-1).join('  '));
    }
  }
}

const head = ['model', 'vertices', 'scheme', 'operation', 'native ms', 'native Mvertices/s', 'wasm ms', 'wasm Mvertices/s', 'native ms on one thread', 'wasm speed / native on one thread', 'native peak bytes / vertex'];
const table = [head, head.map(() => '---'), ...rows].map((row) => `| ${row.join(' | ')} |`).join('\n');
const machine = `quadmark ${await version()}, ${cpus()[0].model}, natively ${cpus().length} threads, as wasm one, Node ${process.versions.node}, medians of ${repeats}, ${new Date().toISOString().slice(0, 10)}`;
const text = `${machine}\n\n${table}\n`;
console.log(text);
if (options.write) {
  const path = join(root, 'docs/performance.md');
  const before = readFileSync(path, 'utf8');
  writeFileSync(path, before.replace(/(<!-- speed -->\n)[\s\S]*(<!-- \/speed -->)/, `$1${text}$2`));
}
