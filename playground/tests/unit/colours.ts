// The palette of a theme, read from the style sheet as a browser reads it.

import { readFileSync } from 'node:fs';
import { type Palette, paletteFrom } from '../../src/view/palette';

const SHEET = readFileSync(new URL('../../src/style/colours.css', import.meta.url), 'utf8');

export function colours(theme: 'light' | 'dark'): Palette {
  return paletteFrom((variable) => {
    const pair = SHEET.match(new RegExp(`${variable}: light-dark\\((#[0-9a-f]{6}), (#[0-9a-f]{6})\\);`));
    if (!pair) throw new Error(`colours.css has no pair of colours for ${variable}`);
    const [red, green, blue] = [1, 3, 5].map((at) =>
      Number.parseInt(pair[theme === 'light' ? 1 : 2].slice(at, at + 2), 16),
    );
    return `rgb(${red}, ${green}, ${blue})`;
  });
}
