// Mouse, pen and touch on the canvas: a press on a particle pulls it, a press on empty canvas moves the view.

import type { Page } from '../page';

/** The largest distance at which a press counts as on a particle, px: a finger is wider than a particle. */
const REACH = { mouse: 12, touch: 28 };
/** Movement below which a press is a click, px. */
const CLICK = 4;
/** A drag across 300 px turns a 3D view by about a third of a circle. */
const ORBIT_PER_PIXEL = 0.007;

/** One finger, pen or mouse button that is down. */
interface Press {
  x: number;
  y: number;
  startX: number;
  startY: number;
  doing: 'pull' | 'pan' | 'orbit' | 'pinch';
  moved: boolean;
  /** where a pulled particle was when the press began, in m: the press moves in the plane through it */
  anchor: number[];
}

export class Pointer {
  private readonly presses = new Map<number, Press>();

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly page: Pick<Page, 'session' | 'hand' | 'readings' | 'stage'>,
  ) {
    canvas.addEventListener('pointerdown', this.down);
    canvas.addEventListener('pointermove', this.move);
    canvas.addEventListener('pointerup', this.up);
    canvas.addEventListener('pointercancel', this.up);
    canvas.addEventListener('pointerleave', () => {
      if (this.presses.size === 0) page.stage.hover = null;
    });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', this.wheel, { passive: false });
  }

  private at(event: MouseEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  private readonly down = (event: PointerEvent) => {
    const [x, y] = this.at(event);
    this.canvas.setPointerCapture(event.pointerId);
    // a press left over from a lost pointer-up must not turn the next touch into a pinch
    if (event.isPrimary) this.presses.clear();
    const turning = event.button === 2 || (event.button === 0 && event.shiftKey);
    const press: Press = { x, y, startX: x, startY: y, doing: 'pan', moved: false, anchor: [] };
    this.presses.set(event.pointerId, press);
    if (this.presses.size > 1) {
      this.page.hand.release();
      for (const other of this.presses.values()) other.doing = 'pinch';
      return;
    }
    const under = this.page.stage.pick(x, y, REACH[event.pointerType === 'touch' ? 'touch' : 'mouse']);
    const spatial = this.page.stage.camera.dimension === 3;
    if (turning && spatial) press.doing = 'orbit';
    else if (
      event.button === 0 &&
      under?.kind === 'particle' &&
      !this.page.session.structure?.fixed[under.index]
    ) {
      press.doing = 'pull';
      press.anchor = this.page.stage.positionOf(under.index);
      this.page.hand.grab(under.index, this.page.stage.camera.unproject(x, y, press.anchor));
      this.page.readings.select(under);
    } else if (event.pointerType === 'touch' && spatial) press.doing = 'orbit';
  };

  private readonly move = (event: PointerEvent) => {
    const [x, y] = this.at(event);
    const press = this.presses.get(event.pointerId);
    if (!press) {
      this.page.stage.hover = this.page.stage.pick(x, y, REACH.mouse);
      this.canvas.style.cursor = this.page.stage.hover ? 'pointer' : '';
      return;
    }
    const [dx, dy] = [x - press.x, y - press.y];
    if (Math.hypot(x - press.startX, y - press.startY) > CLICK) press.moved = true;
    if (press.doing === 'pinch') this.pinch(event.pointerId, x, y);
    else if (press.doing === 'pull')
      this.page.hand.dragTo(this.page.stage.camera.unproject(x, y, press.anchor));
    else if (press.doing === 'orbit') this.page.stage.orbit(dx * ORBIT_PER_PIXEL, dy * ORBIT_PER_PIXEL);
    else if (press.moved) this.page.stage.pan(dx, dy);
    [press.x, press.y] = [x, y];
  };

  private pinch(moving: number, x: number, y: number): void {
    const press = this.presses.get(moving)!;
    const other = [...this.presses].find(([id]) => id !== moving)?.[1];
    if (!other) return;
    const before = Math.hypot(press.x - other.x, press.y - other.y);
    const after = Math.hypot(x - other.x, y - other.y);
    if (before > 1) this.page.stage.zoom(after / before, other.x, other.y);
    // half of the movement: the events of the other finger add the other half
    this.page.stage.pan((x - press.x) / 2, (y - press.y) / 2);
  }

  private readonly up = (event: PointerEvent) => {
    const press = this.presses.get(event.pointerId);
    this.presses.delete(event.pointerId);
    if (!press) return;
    if (press.doing === 'pull') this.page.hand.release();
    if (press.doing === 'pan' && !press.moved && event.type === 'pointerup') {
      const reach = REACH[event.pointerType === 'touch' ? 'touch' : 'mouse'];
      this.page.readings.select(this.page.stage.pick(press.x, press.y, reach));
    }
  };

  private readonly wheel = (event: WheelEvent) => {
    event.preventDefault();
    const [x, y] = this.at(event);
    // lines (Firefox) and pixels to the same feel; a pinch on a touchpad arrives as ctrl-wheel in small steps
    const pixels = event.deltaMode === 1 ? event.deltaY * 18 : event.deltaY;
    this.page.stage.zoom(Math.exp(-pixels * (event.ctrlKey ? 0.01 : 0.0015)), x, y);
  };
}
