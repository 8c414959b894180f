// SPDX-License-Identifier: MIT
import { absences, BESIDE, errorTable, lossesToPaper, paperJobs, PRINTED } from '../paper.mjs';

export const name = 'table4';
export const title = 'Quantization and smoothing (the paper, Table IV)';

export const payload = 'image:24', cases = [...PRINTED, ...BESIDE];
const QUANTIZATION = [
  { bits: 16, printed: { Dragon: 0.1408, Bunny: 0.1038 } },
  { bits: 15, printed: { Dragon: 0.2514, Bunny: 0.1864 } },
  { bits: 14, printed: { Dragon: 0.3977, Bunny: 0.3782 } },
  { bits: 12 }, { bits: 11 }, { bits: 10 },
].map(({ bits, printed }) => ({ label: `${bits} bits`, attack: `quantize:${bits}`, printed }));
const SMOOTHING = [
  { lambda: '1e-4', printed: { Dragon: 0, Bunny: 0 } },
  { lambda: '1e-3', printed: { Dragon: 0.1337, Bunny: 0.1413 } },
  { lambda: '1e-2', printed: { Dragon: 0.3562, Bunny: 0.3454 } },
].map(({ lambda, printed }) => ({ label: `Taubin, lambda ${lambda}, one step`, attack: `smooth:${lambda}`, printed }));
export const attacks = [...QUANTIZATION, ...SMOOTHING];

export const jobs = (context) => paperJobs(context, cases, payload, attacks.map(({ attack }) => attack));
export const losses = (context) => lossesToPaper(context, { title: 'Table IV', payload, cases, attacks });

export const document = (context) => `24 x 24 pixels, bit error rates in percent. Quantization to a grid of 2^bits levels over the longest side, one step for all
axes. Smoothing is Taubin's lambda | mu, mu = -lambda / (1 - .1 lambda).

Scheme \`paper\`:

${errorTable(context, { scheme: 'paper', payload, cases, attacks })}

Scheme \`robust\`:

${errorTable(context, { scheme: 'robust', payload, cases, attacks })}

${absences(context, cases)}`;
