// Colours of the canvas. Tension is blue, compression orange: a pair that every common kind of colour blindness keeps
// apart, and that also differs from the grey of an unloaded rod in lightness.

export interface Palette {
  background: string;
  grid: string;
  ink: string;
  muted: string;
  /** wires and rails: nearer to the background than what moves */
  guide: string;
  accent: string;
  particle: string;
  particleRim: string;
  ghost: string;
  spring: string;
  compression: Rgb;
  slack: Rgb;
  pull: Rgb;
}

type Rgb = readonly [number, number, number];

export const LIGHT: Palette = {
  background: '#f6f5f1',
  grid: '#e7e5de',
  ink: '#1c2126',
  muted: '#6a7078',
  guide: '#a9aca9',
  accent: '#0b7a66',
  particle: '#262c33',
  particleRim: '#f6f5f1',
  ghost: '#5f6670',
  spring: '#767c85',
  compression: [201, 88, 10],
  slack: [168, 172, 178],
  pull: [22, 92, 204],
};

export const DARK: Palette = {
  background: '#12161b',
  grid: '#1e242b',
  ink: '#e8ebee',
  muted: '#929ba6',
  guide: '#6b7682',
  accent: '#46d0ae',
  particle: '#e8ebee',
  particleRim: '#12161b',
  ghost: '#9aa3ae',
  spring: '#848d98',
  compression: [255, 158, 66],
  slack: [92, 100, 110],
  pull: [96, 172, 255],
};

/** Odd, so that zero has a colour of its own. */
export const TENSION_STEPS = 41;

/** The colours from full compression (first) over slack to full tension (last). */
export function tensionColours(palette: Palette): string[] {
  return Array.from({ length: TENSION_STEPS }, (_, step) => {
    const part = (2 * step) / (TENSION_STEPS - 1) - 1;
    return css(mix(palette.slack, part < 0 ? palette.compression : palette.pull, Math.abs(part)));
  });
}

/** Which of the tension colours a rod has; a scale of `limit` newtons each way. */
export function tensionStep(tension: number, limit: number): number {
  const middle = (TENSION_STEPS - 1) / 2;
  if (!Number.isFinite(tension) || !(limit > 0)) return middle;
  return Math.round(middle + middle * Math.min(1, Math.max(-1, tension / limit)));
}

function mix(from: Rgb, to: Rgb, part: number): Rgb {
  // a square root lifts weak colours off the grey; the sign and the order stay
  const weight = Math.sqrt(part);
  return [0, 1, 2].map((i) => Math.round(from[i] + (to[i] - from[i]) * weight)) as unknown as Rgb;
}

function css([red, green, blue]: Rgb): string {
  return `rgb(${red} ${green} ${blue})`;
}
