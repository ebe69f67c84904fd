import { expect, it } from 'vitest';
import type { StepEvent } from '../../src/engine';
import { eventWords, withEvents } from '../../src/session/events';

const event = (time: number, kind: StepEvent['kind'] = 'closed'): StepEvent => ({
  kind,
  constraint: 'floor',
  time,
});

it('keeps the last four events, newest first', () => {
  const first = withEvents([], [event(1), event(2)]);
  expect(first.map(({ time }) => time)).toEqual([2, 1]);
  expect(withEvents(first, [])).toBe(first);
  expect(withEvents(first, [event(3), event(4), event(5)]).map(({ time }) => time)).toEqual([5, 4, 3, 2]);
});

it('says what happened, and how fast an impact was', () => {
  expect(eventWords({ ...event(1, 'impact'), speed: 3.1321 })).toBe('impact at 3.13 m/s');
  expect(eventWords(event(1, 'impact'))).toBe('impact');
  expect(eventWords(event(1, 'slipped'))).toBe('starts to slip');
});
