// The colours of canvas, plots and matrices, read from the variables of style/colours.css once for each theme.

/** Each colour of the palette and the variable that holds it. */
const VARIABLES = {
  background: '--canvas',
  grid: '--grid',
  ink: '--ink',
  outline: '--outline',
  guide: '--guide',
  accent: '--accent',
  particle: '--particle',
  ghost: '--ghost',
  spring: '--spring',
  push: '--push',
  slack: '--slack',
  pull: '--pull',
  plotInk: '--plot-ink',
  plotLine: '--plot-line',
  cell: '--cell',
  cellInk: '--cell-ink',
  onStrongCell: '--on-strong-cell',
  onWeakCell: '--on-weak-cell',
} as const;

export type Palette = Record<keyof typeof VARIABLES, string> & {
  /** from the largest push (first) over no load to the largest pull (last) */
  tension: readonly string[];
};

type Rgb = readonly [number, number, number];

/** Odd, so that zero has a colour of its own; 41 steps look continuous on a line. */
export const TENSION_STEPS = 41;

/** Builds the palette; `read` gives the colour of a variable as `rgb(red, green, blue)`. */
export function paletteFrom(read: (variable: string) => string): Palette {
  const names = Object.keys(VARIABLES) as (keyof typeof VARIABLES)[];
  const colours = Object.fromEntries(names.map((name) => [name, read(VARIABLES[name])]));
  const { push, slack, pull } = colours;
  return {
    ...(colours as Record<keyof typeof VARIABLES, string>),
    tension: tensionColours(push, slack, pull),
  };
}

/** The palette of the theme that the document shows now. */
export function readPalette(): Palette {
  // a variable that holds light-dark(…) is resolved only as the colour of an element
  const probe = document.createElement('span');
  document.body.append(probe);
  const palette = paletteFrom((variable) => {
    probe.style.color = `var(${variable})`;
    return getComputedStyle(probe).color;
  });
  probe.remove();
  return palette;
}

/** The index of the tension colour of a link, on a scale of `limit` newtons each way. */
export function tensionStep(tension: number, limit: number): number {
  const middle = (TENSION_STEPS - 1) / 2;
  if (!Number.isFinite(tension) || !(limit > 0)) return middle;
  return Math.round(middle + middle * Math.min(1, Math.max(-1, tension / limit)));
}

function tensionColours(push: string, slack: string, pull: string): string[] {
  return Array.from({ length: TENSION_STEPS }, (_, step) => {
    const part = (2 * step) / (TENSION_STEPS - 1) - 1;
    return mix(parse(slack), parse(part < 0 ? push : pull), Math.abs(part));
  });
}

function mix(from: Rgb, to: Rgb, part: number): string {
  // a square root lifts weak colours off the grey; the sign and the order stay
  const weight = Math.sqrt(part);
  const [red, green, blue] = from.map((value, i) => Math.round(value + (to[i] - value) * weight));
  return `rgb(${red} ${green} ${blue})`;
}

function parse(colour: string): Rgb {
  return colour.match(/\d+/g)!.map(Number) as unknown as Rgb;
}
