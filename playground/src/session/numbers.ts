// Numbers for people: three digits, a typographic minus sign, and powers of ten in place of long rows of zeros.

const SUPERSCRIPTS: Record<string, string> = {
  '-': '⁻',
  '0': '⁰',
  '1': '¹',
  '2': '²',
  '3': '³',
  '4': '⁴',
  '5': '⁵',
  '6': '⁶',
  '7': '⁷',
  '8': '⁸',
  '9': '⁹',
};

export function format(value: number, digits = 3): string {
  if (Number.isNaN(value)) return '–';
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '−∞';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(Math.max(0, digits - 2)).split('e');
    const power = String(Number(exponent)).replace(/[-\d]/g, (character) => SUPERSCRIPTS[character]);
    return `${minus(mantissa)}·10${power}`;
  }
  const plain = Number(value.toPrecision(digits));
  return minus(String(plain));
}

/** For numbers that change many times a second: a fixed number of decimals does not jump about. */
export function fixed(value: number, decimals: number): string {
  return Number.isFinite(value) ? minus(value.toFixed(decimals)) : '–';
}

/** Size, absolute in m, m/s or N and relative to the largest component, below which a component counts as roundoff. */
const ROUNDING = 1e-12;

export function vector(values: ArrayLike<number>, digits = 3): string {
  const components = Array.from(values);
  const noise = ROUNDING * Math.max(1, ...components.map(Math.abs));
  return `(${components.map((value) => format(Math.abs(value) < noise ? 0 : value, digits)).join(', ')})`;
}

/** An error of the engine as a sentence: with a capital and a full stop. */
export function sentence(message: string): string {
  return message.charAt(0).toUpperCase() + message.slice(1) + (/[.!?]$/.test(message) ? '' : '.');
}

function minus(text: string): string {
  return text.replace('-', '−');
}

/** The least of the numbers 1, 2, 5 × 10ⁿ that is not below a size: the end of a scale. */
export function niceCeiling(size: number): number {
  if (!(size > 0) || !Number.isFinite(size)) return 1;
  const power = 10 ** Math.floor(Math.log10(size));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= size * (1 - 1e-12)) ?? 10;
  return Number((step * power).toPrecision(1));
}
