// SPDX-License-Identifier: MIT
// The forms of a marked model: its bytes, JSON with base64, or a form that every HTTP client can take apart.
import { randomBytes } from 'node:crypto';
import { HttpError } from './errors.js';

const FORMS = ['bytes', 'application/json', 'multipart/form-data'];

/** First form that an Accept header names; q values are not weighed, q=0 is not asked for. */
export function chooseForm(accept = '*/*') {
  for (const item of accept.split(',')) {
    const [type, ...parameters] = item.trim().toLowerCase().split(/\s*;\s*/);
    if (parameters.some((parameter) => /^q=0(\.0*)?$/.test(parameter))) continue;
    if (type === '*/*' || type === 'application/octet-stream' || type === 'application/*' || type.startsWith('model/')) return 'bytes';
    if (FORMS.includes(type)) return type;
  }
  throw new HttpError(406, 'bad_option', 'Accept: the answer is a model, application/json or multipart/form-data');
}

/** Media type of a marked model; marking keeps the format, so there are three. */
function mediaType(bytes) {
  if (bytes[0] === 0x67) return 'model/gltf-binary';  // glTF
  if (bytes[0] === 0x70) return 'model/ply';          // ply
  return 'model/gltf+json';
}

const bufferOf = (bytes) => Buffer.from(bytes.buffer, bytes.byteOffset, bytes.byteLength);

/** Of a form's file names: what would end the header's text is escaped as browsers do. */
const escapeName = (name) => name.replace(/[\r\n"]/g, (character) => encodeURIComponent(character));

function toForm({ bytes, resources }, report) {
  const boundary = `quadmark-${randomBytes(18).toString('hex')}`;
  const parts = [];
  const add = (header, type, content) => {
    parts.push(Buffer.from(`--${boundary}\r\nContent-Disposition: form-data; ${header}\r\nContent-Type: ${type}\r\n\r\n`),
      content, Buffer.from('\r\n'));
  };
  add('name="report"', 'application/json', Buffer.from(JSON.stringify(report)));
  add('name="model"; filename="model"', mediaType(bytes), bytes);
  for (const [uri, content] of Object.entries(resources)) {
    add(`name="resource"; filename="${escapeName(uri)}"`, 'application/octet-stream', content);
  }
  parts.push(Buffer.from(`--${boundary}--\r\n`));
  return { type: `multipart/form-data; boundary=${boundary}`, body: Buffer.concat(parts) };
}

/** { type, body } of a marked model in one of the FORMS. */
export function answerEmbed(form, marked, report) {
  if (form === 'bytes') return { type: mediaType(marked.bytes), body: bufferOf(marked.bytes) };
  if (form === 'multipart/form-data') return toForm(marked, report);
  const resources = Object.fromEntries(Object.entries(marked.resources).map(([uri, content]) => [uri, bufferOf(content).toString('base64')]));
  return { type: 'application/json', body: JSON.stringify({ ...report, model: bufferOf(marked.bytes).toString('base64'), resources }) };
}
