// SPDX-License-Identifier: MIT
// All experiments, in the order of docs/evaluation.md. Each is a module that exports
//
//   name       as --experiment takes it
//   title      its heading in the document
//   jobs(context)           what the native worker has to mark and read: [{ scheme, settings?, payload, model, seed, attacks,
//                           pictures?: { attack: file } }]; no settings: the scheme's usual ones. Asked again until all of
//                           them are done, so that later jobs may depend on earlier rows. May be absent.
//   async run(context)      work of its own, after all jobs: rows by context.rows.add(), leaving out what context.rows.has();
//                           stops early when context.signal is aborted. Returns errors as sentences. May be absent.
//   async tools(context)    { name: version } of the programs that run() uses, for machine.json. May be absent.
//   losses(context)         [{ where, ours, theirs }]: where we lose to a peer or to the paper, for the conclusion. May be absent.
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
import * as distortion from './experiments/distortion.mjs';
import * as chance from './experiments/chance.mjs';
import * as fig5 from './experiments/fig5.mjs';
import * as fig9 from './experiments/fig9.mjs';
import * as fig10 from './experiments/fig10.mjs';
import * as fig11 from './experiments/fig11.mjs';
import * as liris from './experiments/liris.mjs';
import * as models from './experiments/models.mjs';
import * as pictures from './experiments/pictures.mjs';
import * as table1 from './experiments/table1.mjs';
import * as table2 from './experiments/table2.mjs';
import * as table3 from './experiments/table3.mjs';
import * as table4 from './experiments/table4.mjs';
import * as tools from './experiments/tools.mjs';

export const experiments = [table1, table2, table3, table4, fig5, fig9, fig10, fig11, models, liris, distortion, tools, pictures, chance];
