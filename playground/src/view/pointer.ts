// Hands on the canvas: mouse, pen and touch. A particle under the hand is pulled, empty canvas moves the view.

import type { Session } from '../session/session.svelte';
import type { Stage } from './stage';

/** How near is "on" a particle, px: a finger covers what it points at. */
const REACH = { mouse: 12, touch: 28 };
/** Below this a press is a click, px. */
const CLICK = 4;
/** A drag across 300 px turns a 3D view by about a third of a circle. */
const ORBIT_PER_PIXEL = 0.007;

interface Hand {
  x: number;
  y: number;
  startX: number;
  startY: number;
  doing: 'pull' | 'pan' | 'orbit' | 'pinch';
  moved: boolean;
  /** where a pulled particle was when it was taken: the plane the hand moves in */
  anchor: number[];
}

export class Pointer {
  private readonly hands = new Map<number, Hand>();

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly stage: Stage,
    private readonly session: Session,
  ) {
    canvas.addEventListener('pointerdown', this.down);
    canvas.addEventListener('pointermove', this.move);
    canvas.addEventListener('pointerup', this.up);
    canvas.addEventListener('pointercancel', this.up);
    canvas.addEventListener('pointerleave', () => {
      if (this.hands.size === 0) stage.hover = null;
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
    // a hand left over from a lost pointer-up must not turn the next touch into a pinch
    if (event.isPrimary) this.hands.clear();
    const turning = event.button === 2 || (event.button === 0 && event.shiftKey);
    const hand: Hand = { x, y, startX: x, startY: y, doing: 'pan', moved: false, anchor: [] };
    this.hands.set(event.pointerId, hand);
    if (this.hands.size > 1) {
      this.session.release();
      for (const other of this.hands.values()) other.doing = 'pinch';
      return;
    }
    const under = this.stage.pick(x, y, REACH[event.pointerType === 'touch' ? 'touch' : 'mouse']);
    const spatial = this.stage.camera.dimension === 3;
    if (turning && spatial) hand.doing = 'orbit';
    else if (
      event.button === 0 &&
      under?.kind === 'particle' &&
      !this.session.structure?.fixed[under.index]
    ) {
      hand.doing = 'pull';
      hand.anchor = this.stage.positionOf(under.index);
      this.session.grab(under.index, this.stage.camera.unproject(x, y, hand.anchor));
      this.session.select(under);
    } else if (event.pointerType === 'touch' && spatial) hand.doing = 'orbit';
  };

  private readonly move = (event: PointerEvent) => {
    const [x, y] = this.at(event);
    const hand = this.hands.get(event.pointerId);
    if (!hand) {
      this.stage.hover = this.stage.pick(x, y, REACH.mouse);
      this.canvas.style.cursor = this.stage.hover ? 'pointer' : '';
      return;
    }
    const [dx, dy] = [x - hand.x, y - hand.y];
    if (Math.hypot(x - hand.startX, y - hand.startY) > CLICK) hand.moved = true;
    if (hand.doing === 'pinch') this.pinch(event.pointerId, x, y);
    else if (hand.doing === 'pull') this.session.dragTo(this.stage.camera.unproject(x, y, hand.anchor));
    else if (hand.doing === 'orbit') this.stage.orbit(dx * ORBIT_PER_PIXEL, dy * ORBIT_PER_PIXEL);
    else if (hand.moved) this.stage.pan(dx, dy);
    [hand.x, hand.y] = [x, y];
  };

  private pinch(moving: number, x: number, y: number): void {
    const hand = this.hands.get(moving)!;
    const other = [...this.hands].find(([id]) => id !== moving)?.[1];
    if (!other) return;
    const before = Math.hypot(hand.x - other.x, hand.y - other.y);
    const after = Math.hypot(x - other.x, y - other.y);
    if (before > 1) this.stage.zoom(after / before, other.x, other.y);
    // half of the movement: the other finger brings the other half
    this.stage.pan((x - hand.x) / 2, (y - hand.y) / 2);
  }

  private readonly up = (event: PointerEvent) => {
    const hand = this.hands.get(event.pointerId);
    this.hands.delete(event.pointerId);
    if (!hand) return;
    if (hand.doing === 'pull') this.session.release();
    if (hand.doing === 'pan' && !hand.moved && event.type === 'pointerup') {
      const reach = REACH[event.pointerType === 'touch' ? 'touch' : 'mouse'];
      this.session.select(this.stage.pick(hand.x, hand.y, reach));
    }
  };

  private readonly wheel = (event: WheelEvent) => {
    event.preventDefault();
    const [x, y] = this.at(event);
    // lines (Firefox) and pixels to the same feel; a pinch on a touchpad arrives as ctrl-wheel in small steps
    const pixels = event.deltaMode === 1 ? event.deltaY * 18 : event.deltaY;
    this.stage.zoom(Math.exp(-pixels * (event.ctrlKey ? 0.01 : 0.0015)), x, y);
  };
}
