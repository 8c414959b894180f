// SPDX-License-Identifier: MIT
// Marks a model and reads it back, on a page or in a worker.
import { createKey, embed, extract } from 'quadmark';

export async function verify(url) {
  const key = await createKey();
  const { bytes } = await embed(await (await fetch(url)).arrayBuffer(), { key, id: 'C0FFEE' });
  const { verdict, id } = await extract(bytes, { key });
  return `${verdict} ${id}`;
}
