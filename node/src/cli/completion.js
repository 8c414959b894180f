// SPDX-License-Identifier: MIT
// Completion scripts, made from the grammar: commands, options, the values of options that have a fixed set, else files.

export const SHELLS = ['bash', 'zsh', 'fish'];

/** What a command offers: [{ names, description, takesValue, choices }]. */
const optionsOf = (command) => [
  ...command.options.map(({ short, long, description, required, optional, argChoices }) => ({
    names: [short, long].filter(Boolean), description, takesValue: Boolean(required || optional), choices: argChoices ?? [],
  })),
  { names: ['-h', '--help'], description: 'display help', takesValue: false, choices: [] },
];

const wordsOf = (command) => command.registeredArguments.flatMap(({ argChoices }) => argChoices ?? []);

function bash(program) {
  const words = program.commands.map((command) => command.name());
  const cases = program.commands.map((command) => {
    const options = optionsOf(command);
    const values = options.filter(({ takesValue }) => takesValue).map(({ names, choices }) => choices.length > 0
      ? `          ${names.join('|')}) COMPREPLY=($(compgen -W '${choices.join(' ')}' -- "$current")); return ;;`
      : `          ${names.join('|')}) COMPREPLY=($(compgen -f -- "$current")); return ;;`);
    return `      ${command.name()})
        case $previous in
${values.join('\n')}
        esac
        options='${options.flatMap(({ names }) => names).join(' ')}' words='${wordsOf(command).join(' ')}' ;;`;
  });
  return `# bash completion of ${program.name()} ${program.version()}
_${program.name()}() {
  local current=\${COMP_WORDS[COMP_CWORD]} previous=\${COMP_WORDS[COMP_CWORD-1]} options='--help --version' words='${words.join(' ')} help'
  if [ "$COMP_CWORD" -gt 1 ]; then
    case \${COMP_WORDS[1]} in
${cases.join('\n')}
    esac
  fi
  case $current in
    -*) COMPREPLY=($(compgen -W "$options" -- "$current")) ;;
    *) if [ -n "$words" ]; then COMPREPLY=($(compgen -W "$words" -- "$current")); else COMPREPLY=($(compgen -f -- "$current")); fi ;;
  esac
}
complete -o filenames -o bashdefault -F _${program.name()} ${program.name()}
`;
}

/** Text inside single quotes of zsh and fish, with what _arguments reads as its own made literal. */
const zshText = (text) => text.replace(/[\\[\]:]/g, '\\$&').replace(/'/g, `'\\''`);
const fishText = (text) => text.replace(/[\\']/g, '\\$&');

function zsh(program) {
  const cases = program.commands.map((command) => {
    const specs = optionsOf(command).flatMap(({ names, description, takesValue, choices }) => names.map((name) => {
      const value = choices.length > 0 ? `:value:(${choices.join(' ')})` : ':value:_files';
      return `'${name}[${zshText(description)}]${takesValue ? value : ''}'`;
    }));
    const words = wordsOf(command);
    const rest = words.length > 0 ? `'*:word:(${words.join(' ')})'` : `'*:file:_files'`;
    return `    ${command.name()}) _arguments ${[...specs, rest].join(' ')} ;;`;
  });
  const commands = program.commands.map((command) => `'${command.name()}:${zshText(command.description())}'`);
  return `#compdef ${program.name()}
# zsh completion of ${program.name()} ${program.version()}
_${program.name()}() {
  if (( CURRENT == 2 )); then
    local -a commands=(${commands.join(' ')})
    _describe command commands
    _arguments '--help[display help]' '--version[print the version]'
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
${cases.join('\n')}
  esac
}
if [ "$funcstack[1]" = _${program.name()} ]; then _${program.name()} "$@"; else compdef _${program.name()} ${program.name()}; fi
`;
}

function fish(program) {
  const name = program.name();
  const lines = program.commands.flatMap((command) => {
    const seen = `-n '__fish_seen_subcommand_from ${command.name()}'`;
    const options = optionsOf(command).map(({ names, description, takesValue, choices }) => {
      const spelled = names.map((option) => (option.startsWith('--') ? `-l ${option.slice(2)}` : `-s ${option.slice(1)}`)).join(' ');
      const value = !takesValue ? '' : choices.length > 0 ? ` -x -a '${choices.join(' ')}'` : ' -r -F';
      return `complete -c ${name} ${seen} ${spelled}${value} -d '${fishText(description)}'`;
    });
    const words = wordsOf(command);
    return [
      `complete -c ${name} -n __fish_use_subcommand -f -a ${command.name()} -d '${fishText(command.description())}'`,
      ...options,
      ...(words.length > 0 ? [`complete -c ${name} ${seen} -f -a '${words.join(' ')}'`] : []),
    ];
  });
  return `# fish completion of ${name} ${program.version()}\n${lines.join('\n')}\n`;
}

/** The script for one of SHELLS. */
export const completionScript = (program, shell) => ({ bash, zsh, fish })[shell](program);
