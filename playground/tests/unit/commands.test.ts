import { readdirSync, readFileSync } from 'node:fs';
import { expect, it } from 'vitest';
import { COMMANDS, type Command, keysInWords } from '../../src/commands';

const commands: readonly Command[] = COMMANDS;

it('gives every command and every key one home', () => {
  const ids = commands.map(({ id }) => id);
  expect(new Set(ids).size).toBe(ids.length);
  const keys = commands.flatMap(({ keys }) => keys);
  expect(new Set(keys).size).toBe(keys.length);
  // a command without keys is run by its button, a command with keys stands in the help
  for (const { id, keys, help, label } of commands) expect(keys.length > 0 ? help : label, id).toBeTruthy();
});

it('shows the keys as they stand on a keyboard', () => {
  const shown = commands.filter(({ keys }) => keys.length > 0).map(keysInWords);
  expect(shown.join(' ')).toBe('Space . r < > [ ] { } Arrows Shift + arrows + − f g t l Esc ?');
});

it('leaves keys to the keyboard, and buttons of commands to their component', () => {
  const source = new URL('../../src/', import.meta.url);
  const texts = readdirSync(source, { recursive: true, encoding: 'utf8' })
    .filter((file) => /\.(ts|svelte)$/.test(file) && !file.startsWith('wasm'))
    .map((file) => [file, readFileSync(new URL(file, source), 'utf8')] as const);
  const where = (pattern: RegExp) => texts.filter(([, text]) => pattern.test(text)).map(([file]) => file);
  expect(where(/'key(down|up|press)'|onkey/)).toEqual(['keyboard.ts']);
  // each method that a command runs is called in the table alone, or by the console's handle
  const methods = [
    /playback\.(toggle|stepOnce|reset|changeSpeed)\(/,
    /theme\.toggle\(/,
    /panels\.toggleTerms\(/,
    /comparison\.setOn\(/,
    /readings\.select\(null\)/,
    /openNamed\(DEFAULT_SCENE\)/,
  ];
  for (const method of methods) {
    expect(
      where(method).filter((file) => file !== 'handle.ts'),
      String(method),
    ).toEqual(['commands.ts']);
  }
});
