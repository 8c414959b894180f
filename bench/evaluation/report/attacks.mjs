// SPDX-License-Identifier: MIT
// Error rates after growing attacks: all schemes at equal distortion, and the paper's experiments beside its own figures.
import { wasMeasured } from '../models.mjs';
import { casesOf } from '../paper.mjs';
import * as liris from '../experiments/liris.mjs';
import * as table2 from '../experiments/table2.mjs';
import * as table4 from '../experiments/table4.mjs';
import { curveFigure } from './curves.mjs';

const amount = (attack) => attack.split(':')[1];
const share = (attack) => `${Number((100 * amount(attack)).toPrecision(4))} %`;
const steps = (attack) => attack.split(':')[3];

/** Attacks of one kind, as a panel: [title, which ones, their place on the x axis, its title]. */
const LIRIS = [
  ['Noise', /^liris-noise:/, share, 'of the mean distance to the centre'],
  ['Smoothing', /^smooth:/, steps, 'Laplacian steps'],
  ['Quantization, a grid per axis', /^quantize:\d+:per-axis$/, amount, 'bits'],
  ['Quantization, one grid (Draco)', /^quantize:\d+$/, amount, 'bits'],
  ['Simplification', /^simplify:/, share, 'vertices removed'],
  ['Cropping', /^crop:/, share, 'vertices cut off'],
];
const OTHERS = {
  none: 'none',
  'affine::R+affine::S': 'similar',
  reorder: 'order',
  'affine::CB': 'affine',
  'subdivide:1': 'subdivided',
};

function families(context) {
  const all = liris.attacks(context);
  const known = LIRIS.map(([title, which, x, xTitle]) => ({
    title,
    xTitle,
    steps: all.filter(({ attack }) => which.test(attack)).map(({ label, attack }) => ({ label, attack, x: x(attack) })),
  }));
  const others = all
    .filter(({ attack }) => attack in OTHERS)
    .map(({ label, attack }) => ({ label, attack, x: OTHERS[attack] }));
  return [...known, { title: 'Others', xTitle: null, ordered: false, steps: others }].filter(
    (family) => family.steps.length > 0,
  );
}

export const lirisSection = async (context) => {
  const there = liris.models(context).filter((model) => wasMeasured(context, model));
  const of = (limit) =>
    curveFigure({
      title: `${limit[0].toUpperCase()}${limit.slice(1)} limit: surface RMS of at most ${100 * liris.LIMITS[limit]} % of the diagonal`,
      caption: `64-bit IDs in ${there.join(', ')}; of each scheme, model by model, the strongest settings within the
limit. Points are medians over models and keys, bars reach from the lower to the upper quartile; the dashed line is
guessing.`,
      families: families(context),
      series: context.schemes.map(({ name }) => name),
      rowsOf: (name, { attack }) =>
        there.flatMap((model) =>
          liris.readings(
            context,
            context.schemes.find((one) => one.name === name),
            model,
            limit,
            attack,
          ),
        ),
    });
  return (await Promise.all(Object.keys(liris.LIMITS).map(of))).join('\n');
};

const PAPER = [
  ['Noise', table2, /^noise:/, amount, 'amplitude, of the diagonal'],
  ['Simplification by quadrics', table2, /^simplify:.*:qem$/, share, 'vertices removed'],
  ['Simplification by meshoptimizer', table2, /^simplify:[^:]*$/, share, 'triangles removed'],
  ['Quantization', table4, /^quantize:/, amount, 'bits'],
  ['Smoothing, one Taubin step', table4, /^smooth:/, amount, 'lambda'],
];

export function paperSection(context) {
  const there = casesOf(context, table2.cases).filter(({ model }) => wasMeasured(context, model));
  const names = context.quick ? [] : [...new Set(there.flatMap(({ printed }) => printed ?? []))];
  const printed = Object.fromEntries(names.map((name) => [`printed: ${name}`, name]));
  const rowsOf = (one, step) => {
    if (one in printed) return step.printed?.[printed[one]] === undefined ? [] : [{ ber: step.printed[printed[one]] }];
    return there.flatMap(({ model, settings }) =>
      context.rows.select({
        scheme: one,
        settings: one === 'paper' ? settings : undefined,
        payload: table2.payload,
        model,
        attack: step.attack,
      }),
    );
  };
  return curveFigure({
    title: 'The paper’s attacks on 24 x 24 pixels',
    caption: `576 bits in ${there.map(({ model }) => model).join(', ')}: medians over models and keys with quartiles.
What the paper prints of its own models is one figure each, and not of the same unit in the case of noise.`,
    families: PAPER.map(([title, { attacks }, which, x, xTitle]) => ({
      title,
      xTitle,
      steps: attacks.filter(({ attack }) => which.test(attack)).map((one) => ({ ...one, x: x(one.attack) })),
    })),
    series: ['robust', 'paper', ...Object.keys(printed)],
    rowsOf,
  });
}
