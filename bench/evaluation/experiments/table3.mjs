// SPDX-License-Identifier: MIT
import { absences, errorTable, OTHERS, paperJobs, PRINTED } from '../paper.mjs';

export const name = 'table3';
export const title = 'Deformation (the paper, Table III)';

const payload = 'image:24';
const cases = [...PRINTED, ...OTHERS].filter(({ model }) => /^(bunny|nefertiti|ogre|beast|sculpture)/.test(model));
const attacks = [0.25, 0.5, 1, 1.5].map((radians) => ({ label: `bent and twisted by ${radians} rad`, attack: `deform:${radians}` }));

export const jobs = (context) => paperJobs(context, cases, payload, attacks.map(({ attack }) => attack));

export const document = (context) => `24 x 24 pixels, bit error rates in percent. The paper deforms Dinosaur and Raptor, which are not to be had, by the
handles of Au et al. 2006, which is not either: it prints 0 / 0 / 2.2 % and 0 / 0 / 0 %. Here the half of the model beyond the
median of its longest axis is bent and twisted by up to the angle given, the rest stays where it is.

Scheme \`paper\`:

${errorTable(context, { scheme: 'paper', payload, cases, attacks })}

Scheme \`robust\`:

${errorTable(context, { scheme: 'robust', payload, cases, attacks })}

${absences(context, cases)}`;
