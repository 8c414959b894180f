// SPDX-License-Identifier: MIT

/** Why a model is not drawn, as the name of a text. */
export class NotDrawable extends Error {}
