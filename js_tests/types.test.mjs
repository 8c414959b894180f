// SPDX-License-Identifier: MIT
// The hand-written types: what they declare is what the modules export, and the documented use compiles.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import ts from 'typescript';
import * as lab from 'quadmark/lab';
import * as quadmark from 'quadmark';
import * as gltfTransform from 'quadmark/gltf-transform';
import * as recipients from 'quadmark/recipients';
import * as queue from 'quadmark-queue';
import * as server from 'quadmark-server';
import * as vitePlugin from 'quadmark/vite';
import { repository, run, temporaryFolder } from './support/files.mjs';

/** Names of the values (not types) that a .d.ts exports. */
function declaredValues(file) {
  const program = ts.createProgram([file], { noEmit: true, strict: true, target: ts.ScriptTarget.ES2022 });
  const checker = program.getTypeChecker();
  const symbol = checker.getSymbolAtLocation(program.getSourceFile(file));
  return checker.getExportsOfModule(symbol)
    .filter((item) => item.flags & ts.SymbolFlags.Value)
    .map((item) => item.name)
    .sort();
}

/** Messages of the TypeScript compiler on `source` placed inside the workspace. */
function compile(t, source, types = []) {
  const folder = mkdtempSync(join(repository, 'js_tests/.types-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const file = join(folder, 'use.mts');
  writeFileSync(file, source);
  const program = ts.createProgram([file], {
    noEmit: true, strict: true, target: ts.ScriptTarget.ES2022, module: ts.ModuleKind.NodeNext,
    moduleResolution: ts.ModuleResolutionKind.NodeNext, lib: ['lib.es2022.d.ts', 'lib.esnext.float16.d.ts', 'lib.dom.d.ts'], types,
  });
  return ts.getPreEmitDiagnostics(program).map((item) => ts.flattenDiagnosticMessageText(item.messageText, '\n'));
}

test('the types declare exactly what the modules export', () => {
  assert.deepEqual(declaredValues(join(repository, 'node/src/index.d.ts')), Object.keys(quadmark).sort());
  assert.deepEqual(declaredValues(join(repository, 'node/src/lab.d.ts')), Object.keys(lab).sort());
  assert.deepEqual(declaredValues(join(repository, 'node/src/recipient_files.d.ts')), Object.keys(recipients).sort());
  assert.deepEqual(declaredValues(join(repository, 'node/src/gltf_transform/index.d.ts')), Object.keys(gltfTransform).sort());
  assert.deepEqual(declaredValues(join(repository, 'node/src/vite/index.d.ts')), Object.keys(vitePlugin).sort());
  assert.deepEqual(declaredValues(join(repository, 'server/src/index.d.ts')), Object.keys(server).sort());
  assert.deepEqual(declaredValues(join(repository, 'queue/src/index.d.ts')), Object.keys(queue).sort());
});

test('the types know every error code', () => {
  const file = join(repository, 'node/src/index.d.ts');
  const program = ts.createProgram([file], { noEmit: true });
  const checker = program.getTypeChecker();
  const source = program.getSourceFile(file);
  const alias = source.statements.find((node) => ts.isTypeAliasDeclaration(node) && node.name.text === 'ErrorCode');
  const codes = checker.getTypeAtLocation(alias).types.map((type) => type.value).sort();
  assert.deepEqual(codes, Object.keys(quadmark.ERROR_EXIT_STATUS).sort());
});

test('correct use compiles under strict', (t) => {
  const messages = compile(t, `
    import { createKey, embed, extract, inspect, QuadmarkError, recipientId, trace, type Key, type RobustKey } from 'quadmark';
    import { Document } from '@gltf-transform/core';
    import { quadmark as mark, QUADMARK_DEFAULTS } from 'quadmark/gltf-transform';
    import { parseRecipients, parseRegistry, registryLine, type RegistryEntry } from 'quadmark/recipients';
    import { attack } from 'quadmark/lab';
    const model = new Uint8Array(10);
    const key: Key = await createKey({ width: 24, height: 24, owner: 'me' });
    const controller = new AbortController();
    const { bytes, resources, report } = await embed(model, {
      key, image: { width: 2, height: 2, bits: [0, 1, 1, 0] },
      options: { signal: controller.signal, onProgress: ({ stage, done }) => console.log(stage.length, done.toFixed(2)) },
    });
    const warnings: string[] = report.warnings;
    const damaged = await attack(bytes, { kind: 'crop', amount: 0.5, resources });
    const { verdict, image, id } = await extract(damaged.bytes, { key: JSON.stringify(key), reference: bytes });
    const text: 'match' | 'none' | 'inconclusive' = verdict;
    const confidence: Float32Array | undefined = image?.confidence;
    const robust: RobustKey = await createKey({ owner: 'me' });
    const bare: RobustKey = await createKey(), named2: RobustKey = await createKey({ scheme: 'robust' });
    const named = await embed(model, { key: robust, text: 'chair 42', options: { strength: 'strong', maxError: 1e-3, salt: 'chair', selfTest: true } });
    const found = await extract(named.bytes, { key: robust, expectText: 'chair 42', options: { salt: 'chair' } });
    const name: string | null = found.text, evidence: Float32Array = found.evidence;
    console.log(name, evidence.length, bare.scheme, named2.scheme);
    const hex: string | null = id;
    try { await inspect(model); } catch (error) {
      if (error instanceof QuadmarkError && error.code === 'bad_file') console.log(error.message);
    }
    console.log(warnings, text, confidence, hex);
    const entries: RegistryEntry[] = parseRegistry('').entries;
    const { recipient, trials } = await trace(named.bytes, { key: robust, candidates: [...entries, { recipient: 'Bob', id: await recipientId(robust, 'Bob') }] });
    await new Document().transform(mark({ key: robust, id: 1n, strength: QUADMARK_DEFAULTS.strength, onReport: ({ warnings: said }) => console.log(said) }));
    console.log(recipient?.length, trials.toFixed(), parseRecipients('recipient\\nBob')[0].line, registryLine(entries[0]));
  `);
  assert.deepEqual(messages, []);
});

test('misuse does not compile', (t) => {
  const wrong = [
    `import { embed } from 'quadmark'; await embed('model.ply', { key: {} as any });`,
    `import { embed } from 'quadmark'; await embed(new Uint8Array(1), { image: new Uint8Array(1) });`,
    `import { QuadmarkError } from 'quadmark'; new QuadmarkError('no_such_code', '');`,
    `import { createKey } from 'quadmark'; await createKey({ scheme: 'sturdy' });`,
    `import { createKey } from 'quadmark'; await createKey({ scheme: 'robust', width: 24, height: 24 });`,
    `import { embed } from 'quadmark'; await embed(new Uint8Array(1), { key: '', id: '1', options: { strength: 'weak' } });`,
  ];
  for (const source of wrong) assert.notEqual(compile(t, source).length, 0, source);
});

test('the reference is made from the types, and nothing in it is undocumented', { timeout: 120000 }, async (t) => {
  const out = temporaryFolder(t);
  const made = await run(process.execPath, [join(repository, 'node_modules/.bin/typedoc'), '--out', out], { cwd: join(repository, 'node') });
  assert.equal(made.status, 0, `${made.stdout}${made.stderr}`);
  const modules = readFileSync(join(out, 'modules.html'), 'utf8');
  const { exports } = JSON.parse(readFileSync(join(repository, 'node/package.json'), 'utf8'));
  for (const [entry, { types }] of Object.entries(exports)) {
    if (types !== undefined) assert.ok(modules.includes(`>${entry.replace('.', 'quadmark')}<`), `${entry} is in the reference`);
  }
});
