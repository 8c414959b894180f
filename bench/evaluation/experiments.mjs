// SPDX-License-Identifier: MIT
// All experiments, in the order of docs/evaluation.md. Each is a module that exports
//
//   name       as --experiment takes it
//   title      its heading in the document
//   jobs(context)           what the native worker has to mark and read: [{ scheme, settings?, payload, model, seed, attacks,
//                           pictures?: { attack: file } }]; no settings: the scheme's usual ones. May be absent.
//   async run(context)      work of its own, after all jobs: rows by context.rows.add(), leaving out what context.rows.has();
//                           stops early when context.signal is aborted. Returns errors as sentences. May be absent.
//   async tools(context)    { name: version } of the programs that run() uses, for machine.json. May be absent.
//   document(context)       Markdown of its section, without the heading, from context.rows alone
//
// A context is
//   quick      whether this run is to end within minutes: generated models, few of everything
//   seeds      [1, 2, ...], the outer loop of run()
//   schemes    [{ name, usualSettings }] of bench/schemes/schemes.cpp
//   rows       Rows of rows.mjs
//   folder     where files of this run may be left (pictures, other CSVs): bench/results, or below build/evaluation
//   parallel   how many processes may work at once
//   signal     AbortSignal of Ctrl-C
//   progress   { expect(count): that many steps are to come, update(label, share), ended(label) }
import * as table1 from './experiments/table1.mjs';

export const experiments = [table1];
