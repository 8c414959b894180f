// SPDX-License-Identifier: MIT
// Where real work belongs: the page stays alive meanwhile.
import { verify } from './verify.js';

onmessage = ({ data }) => {
  verify(data).then(postMessage, (error) => postMessage(String(error)));
};
