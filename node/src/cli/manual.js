// SPDX-License-Identifier: MIT
// The manual page, made from the help: what `quadmark man` prints and the package carries as man/quadmark.1.

/** Text as roff shows it: backslashes and leading dots or quotes are its own syntax, and minus signs stay ASCII. */
const escape = (text) => text.replace(/\\/g, '\\e').replace(/-/g, '\\-').replace(/^([.'])/gm, '\\&$1');

/** A block whose lines stay as they are. */
const verbatim = (text) => `.nf\n${escape(text)}\n.fi`;

/** What addHelpText('after') puts behind the help of a command. */
function textAfter(command) {
  let text = '';
  command.emit('afterHelp', { write: (more) => { text += more; }, command, error: false });
  return text.replace(/^\n+|\n+$/g, '');
}

function section(command, help) {
  const rows = [
    ...help.visibleArguments(command).map((item) => [`<${item.name()}>`.replace('>', item.variadic ? '...>' : '>'), help.argumentDescription(item)]),
    ...help.visibleOptions(command).map((item) => [help.optionTerm(item), help.optionDescription(item)]),
  ];
  const after = textAfter(command);
  return [
    `.SS ${escape(help.commandUsage(command).replace(/^quadmark /, ''))}`,
    `${escape(command.description())}.`,
    ...rows.map(([term, text]) => `.TP\n.B ${escape(term)}\n${escape(text)}`),
    ...(after === '' ? [] : [`.PP\n${verbatim(after)}`]),
  ].join('\n');
}

/** The page as roff for man(1). */
export function manualPage(program) {
  const help = program.createHelp();
  return `.\\" Made by "quadmark man" from the program's help.
.TH QUADMARK 1 "" "quadmark ${program.version()}" "User Commands"
.SH NAME
quadmark \\- ${escape(program.description().replace(/\.$/, ''))}
.SH SYNOPSIS
.B quadmark
.I command
[options] [names]
.SH COMMANDS
${program.commands.map((command) => section(command, help)).join('\n')}
.SH NOTES
${verbatim(textAfter(program))}
.SH SEE ALSO
README.md of the package.
`;
}
