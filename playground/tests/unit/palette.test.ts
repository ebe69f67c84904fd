import { readdirSync, readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { TENSION_STEPS, tensionStep } from '../../src/view/palette';
import { STYLES } from '../../src/view/shapes/styles';
import { colours } from './colours';

type Rgb = [number, number, number];
const parse = (css: string) => css.match(/\d+/g)!.map(Number) as Rgb;

// Simulation of deuteranopia and protanopia in linear RGB: Machado, Oliveira, Fernandes (2009), severity 1.
const BLINDNESS = {
  deuteranopia: [0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.01182, 0.04294, 0.968881],
  protanopia: [0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998],
  tritanopia: [1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.3039],
};

function seen(colour: Rgb, matrix: readonly number[]): Rgb {
  const linear = colour.map((x) => (x / 255) ** 2.2);
  return [0, 1, 2].map((r) => {
    const value = [0, 1, 2].reduce((sum, c) => sum + matrix[3 * r + c] * linear[c], 0);
    return 255 * Math.max(0, Math.min(1, value)) ** (1 / 2.2);
  }) as Rgb;
}

const distance = (a: Rgb, b: Rgb) => Math.hypot(...a.map((x, k) => x - b[k]));

describe('the tension colours', () => {
  it('put zero in the middle and the sign to its sides', () => {
    const middle = (TENSION_STEPS - 1) / 2;
    expect(tensionStep(0, 10)).toBe(middle);
    expect(tensionStep(10, 10)).toBe(TENSION_STEPS - 1);
    expect(tensionStep(-99, 10)).toBe(0);
    expect(tensionStep(Number.NaN, 10)).toBe(middle);
    expect(tensionStep(5, 0)).toBe(middle);
  });

  it.each(Object.entries(BLINDNESS))('differ under %s', (_, matrix) => {
    for (const theme of ['light', 'dark'] as const) {
      const { tension } = colours(theme);
      const [push, slack, pull] = [0, (TENSION_STEPS - 1) / 2, TENSION_STEPS - 1].map((step) =>
        seen(parse(tension[step]), matrix),
      );
      // 60 of 441 is several times the smallest difference that an eye sees on a 3 px line
      expect(distance(push, pull)).toBeGreaterThan(60);
      expect(distance(push, slack)).toBeGreaterThan(60);
      expect(distance(pull, slack)).toBeGreaterThan(60);
    }
  });
});

it('colours stand in colours.css and nowhere else', () => {
  const source = new URL('../../src/', import.meta.url);
  const files = readdirSync(source, { recursive: true, encoding: 'utf8' }).filter(
    (file) => /\.(ts|svelte|css)$/.test(file) && !file.startsWith('wasm') && !file.endsWith('colours.css'),
  );
  expect(files.length).toBeGreaterThan(40);
  const literal = /#[0-9a-f]{6}\b|#[0-9a-f]{3}\b|\b(rgb|hsl)a?\(\s*\d/i;
  expect(files.filter((file) => literal.test(readFileSync(new URL(file, source), 'utf8')))).toEqual([]);
});

/** A source file of the crate that draws pictures for `qhat render`. */
const drawing = (name: string) =>
  readFileSync(new URL(`../../../crates/qhat-shapes/src/picture/${name}`, import.meta.url), 'utf8');

it('pictures of the command have the strokes of the page', () => {
  const pattern = /style\(&\[([^\]]+)\], (\w+), ([\d.]+), [\w:]+\)(?:, \[([\d., ]+)\]\)|, ([\d.]+)\))?,\n/g;
  const kebab = (name: string) => name.replace(/(?<=[a-z])[A-Z]/g, (letter) => `-${letter}`).toLowerCase();
  const theirs = [...drawing('styles.rs').matchAll(pattern)].map(([, kinds, colour, width, dash, fill]) => ({
    kinds: kinds.split(', ').map((kind) => kebab(kind.replace('Kind::', ''))),
    colour: kebab(colour),
    width: Number(width),
    dash: dash?.split(', ').map(Number),
    fill: fill === undefined ? undefined : Number(fill),
  }));
  const ours = STYLES.map(({ kinds, colour, width, dash, fill }) => ({ kinds, colour, width, dash, fill }));
  // the page draws nails in a layer of their own
  const shown = theirs.filter(({ kinds }) => !kinds.includes('nail'));
  expect(shown.length).toBe(theirs.length - 1);
  const inOrder = (styles: readonly object[]) => styles.map((style) => JSON.stringify(style)).sort();
  expect(inOrder(shown)).toEqual(inOrder(ours));
});
