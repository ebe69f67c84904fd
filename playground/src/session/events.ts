// The last events of a run: impacts, contacts that open and close, slip, breaks.

import type { StepEvent } from '../engine';
import { format } from './numbers';

/** Events that a panel lists; older events scroll away too fast to be read. */
const KEPT = 4;

const WORDS: Record<StepEvent['kind'], string> = {
  impact: 'impact',
  closed: 'closes',
  opened: 'opens',
  slipped: 'starts to slip',
  stuck: 'stops slipping',
  broke: 'breaks',
};

/** The kind of an event in words; for an impact with its closing speed. */
export function eventWords({ kind, speed }: StepEvent): string {
  return kind === 'impact' && speed !== undefined ? `impact at ${format(speed)} m/s` : WORDS[kind];
}

/** The last events after some new ones, newest first. */
export function withEvents(last: readonly StepEvent[], fresh: readonly StepEvent[]): readonly StepEvent[] {
  return fresh.length === 0 ? last : [...fresh].reverse().concat(last).slice(0, KEPT);
}
