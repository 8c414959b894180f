// SPDX-License-Identifier: MIT
// The command lines whose survival is measured. Steps are joined by " | "; file names are left out.
//
// expects: what must be true of what the tool made, or the row is a failure of the tool (made.mjs):
//   bits       positions lie on a grid of at most so many bits
//   uses       the extension that the file must use
//   removes    whether vertices must have gone
// says: what stands in tables where the line is not what one would type. quick: part of `bench/evaluate --quick`.

const DRACO = 'KHR_draco_mesh_compression';
const MESHOPT = ['EXT_meshopt_compression', 'KHR_meshopt_compression'];

const inScene = (share, line) => ({ line: `scene 1/${share} | ${line}`, says: `object of 1/${share} of its scene, \`${line}\`` });

export const TOOL_LINES = [
  { line: 'gltf-transform copy' },
  { line: 'gltf-transform quantize', expects: { bits: 14 } },
  { line: 'gltf-transform weld' },
  { line: 'gltf-transform simplify' },
  { line: 'gltf-transform draco', expects: { bits: 14, uses: [DRACO] } },
  { line: 'gltf-transform meshopt', expects: { bits: 14, uses: MESHOPT } },
  { line: 'gltf-transform optimize', expects: { bits: 14, uses: MESHOPT }, quick: true },
  { line: 'gltf-transform optimize --simplify false', expects: { bits: 14, uses: MESHOPT } },
  { line: 'gltf-transform optimize --compress draco', expects: { bits: 14, uses: [DRACO] } },
  { line: 'gltfpack', expects: { bits: 14 }, quick: true },
  { line: 'gltfpack -c', expects: { bits: 14, uses: MESHOPT } },
  { line: 'gltfpack -cc', expects: { bits: 14, uses: MESHOPT }, quick: true },
  { line: 'gltfpack -cz', expects: { bits: 14, uses: MESHOPT } },
  { line: 'gltfpack -vp 16', expects: { bits: 16 } },
  { line: 'gltfpack -vp 12', expects: { bits: 12 } },
  { line: 'gltfpack -vpf' },
  { line: 'gltfpack -noq', quick: true },
  { line: 'gltfpack -si 0.5', expects: { bits: 14, removes: true }, quick: true },
  ...[16, 14, 12, 11, 10].map((bits) => ({ line: `draco_encoder -qp ${bits}`, expects: { bits } })),
  { line: 'draco_transcoder', expects: { bits: 11, uses: [DRACO] } },
  { line: 'gltf-pipeline -d', expects: { bits: 11, uses: [DRACO] }, quick: true },
  { line: 'gltfjsx -T', expects: { uses: [DRACO] } },
  { line: 'three GLTFExporter', says: "three's `GLTFExporter`", quick: true },
  { line: 'three DRACOExporter', expects: { bits: 16 }, says: "three's `DRACOExporter`", quick: true },
  { line: 'three OBJExporter', says: "OBJ by three and back (`OBJExporter`, `OBJLoader`)" },
  { line: 'three STLExporter', says: "STL by three and back (`STLExporter`, `STLLoader`)" },
  { line: 'three PLYExporter', says: "ASCII PLY by three's `PLYExporter`" },
  { line: 'assimp obj', says: '`assimp export` to OBJ and back' },
  { line: 'assimp stl', says: '`assimp export` to STL and back' },
  { line: 'assimp ply', says: '`assimp export` to ASCII PLY' },
  { line: 'blender glb', says: 'Blender, GLB in, GLB out' },
  { line: 'blender glb draco', expects: { bits: 14, uses: [DRACO] }, says: 'Blender, GLB in, GLB with Draco out' },
  { line: 'blender obj', says: 'Blender to OBJ and back' },
  { line: 'blender stl', says: 'Blender to STL and back' },
  { line: 'blender ply', says: 'Blender to ASCII PLY' },
  ...[20, 100].flatMap((share) => [
    inScene(share, 'gltf-transform optimize'),
    inScene(share, 'gltf-transform optimize --simplify false'),
    inScene(share, 'gltfpack'),
  ]),
];

/** Our own marks that are sent through them, and how tables head their columns. */
export const OURS = [
  { head: '`robust`', scheme: 'robust', settings: 'standard' },
  { head: '`robust`, `strong`', scheme: 'robust', settings: 'strong' },
  { head: '`paper`, L = 2', scheme: 'paper', settings: 'L=2' },
];

/** The head of a row in a table. */
export const labelOf = (line) => TOOL_LINES.find((tool) => tool.line === line)?.says ?? `\`${line}\``;
