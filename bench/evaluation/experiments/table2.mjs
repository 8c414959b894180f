// SPDX-License-Identifier: MIT
import { absences, BESIDE, errorTable, lossesToPaper, paperJobs, PRINTED } from '../paper.mjs';

export const name = 'table2';
export const title = 'Noise and simplification (the paper, Table II)';

export const payload = 'image:24', cases = [...PRINTED, ...BESIDE];
const NOISE = [
  { label: 'noise 1e-6', attack: 'noise:1e-6' },
  { label: 'noise 1e-5', attack: 'noise:1e-5', printed: { Fandisk: 0.1262, Dragon: 0, Buddha: 0, Bunny: 0 } },
  { label: 'noise 1e-4', attack: 'noise:1e-4', printed: { Fandisk: 0.3011, Dragon: 0.1631, Buddha: 0.1548, Bunny: 0.1346 } },
  { label: 'noise 1e-3', attack: 'noise:1e-3', printed: { Fandisk: 0.4903, Dragon: 0.3977, Buddha: 0.3825, Bunny: 0.3837 } },
];
const PRINTED_SIMPLIFICATION = {
  10: { Fandisk: 0, Dragon: 0, Buddha: 0, Bunny: 0 },
  20: { Fandisk: 0, Dragon: 0, Buddha: 0, Bunny: 0 },
  30: { Fandisk: 0.0403, Dragon: 0.17, Buddha: 0.034, Bunny: 0.0351 },
  40: { Fandisk: 0.2715, Dragon: 0.3244, Buddha: 0.2923, Bunny: 0.1923 },
};
const SIMPLIFICATION = Object.entries(PRINTED_SIMPLIFICATION).map(([removed, printed]) =>
  ({ label: `QEM, ${removed} % of the vertices removed`, attack: `simplify:${removed / 100}:qem`, printed }));
const SURVIVORS = Object.keys(PRINTED_SIMPLIFICATION).map((removed) =>
  ({ label: `meshoptimizer, ${removed} % of the triangles removed`, attack: `simplify:${removed / 100}` }));
export const attacks = [...NOISE, ...SIMPLIFICATION, ...SURVIVORS];

export const jobs = (context) => paperJobs(context, cases, payload, attacks.map(({ attack }) => attack));
export const losses = (context) => lossesToPaper(context, {
  title: 'Table II', payload, cases,
  attacks: attacks.map((one) => (NOISE.includes(one) ? { ...one, label: `${one.label}, whose unit in the paper is unknown` } : one)),
});

export const document = (context) => `24 x 24 pixels (576 bits), bit error rates in percent. Noise is uniform in [-a, a] per coordinate, a relative to the
diagonal of the bounding box. The paper does not say to what its amplitudes are relative, and its noise and quantization rows
contradict each other (16 bits, whose steps are 1.5e-5, cost it more than noise of 1e-5): do not compare the noise rows.
QEM is quadric edge collapse with optimal placement, as in QSlim; meshoptimizer's survivors keep their coordinates. Fandisk
and part with L = 3, H = 4, the others with L = 2, H = 3.

Scheme \`paper\`:

${errorTable(context, { scheme: 'paper', payload, cases, attacks })}

Scheme \`robust\`, the same pictures and attacks:

${errorTable(context, { scheme: 'robust', payload, cases, attacks })}

${absences(context, cases)}`;
