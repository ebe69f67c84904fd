import { expect, it } from 'vitest';
import { grouped } from '../../src/session/gallery';

it('puts scenes under their headings in the order in which they come', () => {
  const scene = (name: string, group: string) => ({ name, group, title: name, text: '' });
  const groups = grouped([scene('a', 'one'), scene('b', 'two'), scene('c', 'one')]);
  expect(groups.map(({ heading, scenes }) => [heading, scenes.map(({ name }) => name)])).toEqual([
    ['one', ['a', 'c']],
    ['two', ['b']],
  ]);
});
