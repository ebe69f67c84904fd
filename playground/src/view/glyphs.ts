// The signs on the canvas: zig-zag springs, nails, discs, squares, arrows, lines. All take screen coordinates in px.

/** A spring between two points: straight ends and a zig-zag whose number of turns does not depend on its length. */
export function traceSpring(
  context: CanvasRenderingContext2D,
  ax: number,
  ay: number,
  bx: number,
  by: number,
  width: number,
  turns: number,
): void {
  const length = Math.hypot(bx - ax, by - ay);
  context.moveTo(ax, ay);
  if (length > 1) {
    const [ux, uy] = [(bx - ax) / length, (by - ay) / length];
    const end = Math.min(0.2 * length, 14);
    const coil = length - 2 * end;
    for (let k = 0; k <= 2 * turns; k += 1) {
      const along = end + (coil * (k + 0.5)) / (2 * turns + 1);
      const side = k % 2 === 0 ? width : -width;
      context.lineTo(ax + ux * along - uy * side, ay + uy * along + ux * side);
    }
  }
  context.lineTo(bx, by);
}

export function traceCircle(context: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  context.moveTo(x + radius, y);
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

/** A nail: a ring with a cross. */
export function traceNail(context: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  traceCircle(context, x, y, radius);
  const arm = radius + 4;
  context.moveTo(x - arm, y);
  context.lineTo(x + arm, y);
  context.moveTo(x, y - arm);
  context.lineTo(x, y + arm);
}

/** A fixed particle: a square. */
export function traceFixed(context: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  context.rect(x - radius, y - radius, 2 * radius, 2 * radius);
}

export function drawArrow(
  context: CanvasRenderingContext2D,
  x: number,
  y: number,
  dx: number,
  dy: number,
  label: string,
): void {
  const length = Math.hypot(dx, dy);
  if (length < 2) return;
  const [ux, uy] = [dx / length, dy / length];
  const head = Math.min(9, 0.5 * length);
  const [tx, ty] = [x + dx, y + dy];
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(tx - ux * head * 0.8, ty - uy * head * 0.8);
  context.stroke();
  context.beginPath();
  context.moveTo(tx, ty);
  context.lineTo(tx - ux * head - uy * head * 0.45, ty - uy * head + ux * head * 0.45);
  context.lineTo(tx - ux * head + uy * head * 0.45, ty - uy * head - ux * head * 0.45);
  context.fill();
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText(label, tx + ux * 13, ty + uy * 13);
}

/** A straight line between two particles. */
export function traceSegment(
  context: CanvasRenderingContext2D,
  screen: Float64Array,
  [a, b]: readonly number[],
): void {
  context.moveTo(screen[3 * a], screen[3 * a + 1]);
  context.lineTo(screen[3 * b], screen[3 * b + 1]);
}

/** Least distance of drawn points of a chain, px. Nearer points are left out; anti-aliasing hides the difference. */
const FINEST = 0.75;

/** Rods as lines. Rods that follow one another make one line, with no more points than a screen shows. */
export function traceChains(
  context: CanvasRenderingContext2D,
  screen: Float64Array,
  rods: readonly { particles: readonly number[] }[],
): void {
  let [end, x, y] = [-1, 0, 0];
  let owed = false;
  const settle = () => {
    if (owed) context.lineTo(screen[3 * end], screen[3 * end + 1]);
    owed = false;
  };
  for (const { particles } of rods) {
    const [a, b] = [particles[0], particles[1]];
    if (a !== end) {
      settle();
      [x, y] = [screen[3 * a], screen[3 * a + 1]];
      context.moveTo(x, y);
    }
    end = b;
    const [bx, by] = [screen[3 * b], screen[3 * b + 1]];
    owed = Math.abs(bx - x) + Math.abs(by - y) < FINEST;
    if (owed) continue;
    context.lineTo(bx, by);
    [x, y] = [bx, by];
  }
  settle();
}
