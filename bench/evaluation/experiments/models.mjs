// SPDX-License-Identifier: MIT
import { errorCell, meanCell, measuredTable } from '../cells.mjs';
import { wasMeasured } from '../models.mjs';
import { absences, casesOf, OTHERS, PRINTED } from '../paper.mjs';

export const name = 'models';
export const title = 'Both schemes on every model';

const ATTACKS = {
  none: 'none', reorder: 'reorder:1', R: 'affine::R', NS: 'affine::NS', RE: 'affine::RE', S: 'affine::S', SH: 'affine::SH', CB: 'affine::CB',
  'crop 50 %': 'crop:0.5', 'crop 92 %': 'crop:0.92', 'simplify 30 %': 'simplify:0.3', 'QEM 30 %': 'simplify:0.3:qem', deform: 'deform:0.5',
  'local noise 1e-3': 'local-noise:1e-3', 'noise 1e-6': 'noise:1e-6', 'noise 1e-5': 'noise:1e-5', 'noise 1e-4': 'noise:1e-4', '6 digits': 'digits:6',
  '16 bit': 'quantize:16', '14 bit': 'quantize:14', '11 bit': 'quantize:11', 'Taubin 1e-4': 'smooth:1e-4',
};
// Small models of web builds, most of them too small for a mark: the section of what has no figures says why.
const SMALL = ['CesiumMan.glb', 'Fox.gltf', 'moltenDagger.glb', 'shaderBall.glb', 'riggedMesh.glb', 'morphLoader.glb', 'AnimatedMorphCube.gltf',
  'cube_att.gltf', 'SimpleSparseAccessor.gltf', 'Box_Draco.glb', 'bunny_gltf.drc'];
const all = [...PRINTED, ...OTHERS, ...SMALL.map((model) => ({ model, settings: 'L=2' }))];
const large = [...PRINTED, { model: 'sculpture:40000:3', settings: 'L=2' }, { model: 'part:12000:2', settings: 'L=3' }];
const smaller = (context) => casesOf(context, all).map((one) => ({ scheme: 'paper', ...one, payload: 'image:24' }));
const larger = (context) => (context.quick ? [] : large.map((one) => ({ scheme: 'paper', ...one, payload: 'image:90' })));
const named = (context) => casesOf(context, all).map(({ model }) => ({ scheme: 'robust', settings: 'standard', payload: 'id', model }));

export const jobs = (context) => [...smaller(context), ...larger(context), ...named(context)].flatMap(({ scheme, settings, payload, model }) =>
  context.seeds.map((seed) => ({ scheme, settings, payload, model, seed, attacks: Object.values(ATTACKS) })));

function table(context, marks) {
  const rows = marks.filter(({ model }) => wasMeasured(context, model)).map(({ scheme, settings, payload, model }) => {
    const of = (attack) => context.rows.select({ scheme, settings, payload, model, attack });
    return [model, meanCell(of('mark'), 'vertices', (x) => x.toFixed(0)), meanCell(of('mark'), 'carriers', (x) => x.toFixed(0)),
      meanCell(of('mark'), 'snr', (x) => x.toFixed(1)), ...Object.values(ATTACKS).map((attack) => errorCell(of(attack)))];
  });
  return measuredTable(['model', 'vertices', scheme(marks), 'SNR dB', ...Object.keys(ATTACKS)], rows);
}
const scheme = (marks) => (marks[0].scheme === 'paper' ? 'cells' : 'carriers');

export const document = (context) => `Bit error rates in percent after each attack; "exact": every bit right with every key. Amplitudes are fractions of the
diagonal; R, NS, RE, S, SH, CB are the paper's affine maps in float32; "simplify" is meshoptimizer's, "QEM" quadric edge collapse with
optimal placement; "local noise" is on half of the vertices; bits are of a common grid. What \`robust\` reads on which kinds of models is
in [robust.md](robust.md).

Scheme \`paper\`, 24 x 24 pixels; L = 3 on Fandisk and part, else 2:

${table(context, smaller(context))}
${larger(context).length > 0 ? `\nScheme \`paper\`, 90 x 90 pixels:\n\n${table(context, larger(context))}\n` : ''}
Scheme \`robust\`, 64-bit IDs at \`standard\`:

${table(context, named(context))}

${absences(context, all)}`;
