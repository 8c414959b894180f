// SPDX-License-Identifier: MIT
// `new URL('./model.glb', import.meta.url)`: Vite reads such a file itself, past all plugins. An import of its URL is seen.

const isImportMetaUrl = (node) =>
  node?.type === 'MemberExpression' && node.object.type === 'MetaProperty' && node.property.name === 'url' && !node.computed;

const textOf = (node) => {
  if (node?.type === 'Literal' && typeof node.value === 'string') return node.value;
  return node?.type === 'TemplateLiteral' && node.expressions.length === 0 ? node.quasis[0].value.cooked : null;
};

function* nodesOf(node) {
  if (Array.isArray(node)) {
    for (const item of node) yield* nodesOf(item);
  } else if (typeof node?.type === 'string') {
    yield node;
    for (const child of Object.values(node)) if (typeof child === 'object' && child !== null) yield* nodesOf(child);
  }
}

/**
 * The code with the URLs of models imported, or null where it has none. The imports stand at its end, so that no line moves.
 * @param ast      of ESTree, of the whole module
 * @param isModel  (relative URL) => boolean
 */
export function importsForUrls(ast, code, isModel) {
  const found = [];
  for (const node of nodesOf(ast)) {
    if (node.type !== 'NewExpression' || node.callee.name !== 'URL' || !isImportMetaUrl(node.arguments[1])) continue;
    const url = textOf(node.arguments[0]);
    if (url !== null && /^\.{1,2}\//.test(url) && isModel(url)) found.push({ url, ...node.arguments[0] });
  }
  if (found.length === 0) return null;
  let out = '', at = 0;
  const imports = [];
  found.sort((a, b) => a.start - b.start).forEach(({ url, start, end }, i) => {
    const name = `__quadmark_url_${i}`;
    out += code.slice(at, start) + name;
    at = end;
    imports.push(`import ${name} from ${JSON.stringify(url.includes('?') ? url : `${url}?url`)};`);
  });
  return { code: `${out}${code.slice(at)}\n${imports.join('\n')}\n`, map: null };
}
