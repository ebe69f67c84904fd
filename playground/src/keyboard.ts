// Runs the commands from the keyboard.

import { COMMANDS, type Command } from './commands';
import type { Page } from './page';

export class Keyboard {
  /** the keys that are down, with the command that each of them ran */
  private readonly held = new Map<string, Command>();

  constructor(private readonly page: Page) {
    window.addEventListener('keydown', this.down);
    window.addEventListener('keyup', ({ key }) => this.release(key));
    window.addEventListener('blur', () => {
      for (const key of [...this.held.keys()]) this.release(key);
    });
  }

  private readonly down = (event: KeyboardEvent) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    if (isForElement(event)) return;
    const found = this.find(event);
    if (!found) return;
    const { command, key } = found;
    event.preventDefault();
    if (!command.enabled(this.page)) return;
    this.held.set(event.key, command);
    command.run(this.page, key);
  };

  /** The command of a key. An arrow with Shift falls back to the plain arrow where the view cannot turn. */
  private find({ key, shiftKey }: KeyboardEvent): { command: Command; key: string } | undefined {
    const keys = shiftKey && key.startsWith('Arrow') ? [`Shift+${key}`, key] : [key];
    const found = keys.flatMap((each) => {
      const command = commandOfKey(each);
      return command ? [{ command, key: each }] : [];
    });
    return found.find(({ command }) => command.enabled(this.page)) ?? found[0];
  }

  private release(key: string): void {
    const command = this.held.get(key);
    this.held.delete(key);
    if (command && ![...this.held.values()].includes(command)) command.release?.(this.page);
  }
}

function commandOfKey(key: string): Command | undefined {
  return (COMMANDS as readonly Command[]).find(({ keys }) => keys.includes(key));
}

/** Whether the element with the focus handles the key itself. */
function isForElement({ target, key }: KeyboardEvent): boolean {
  if (!(target instanceof Element)) return false;
  const dialog = target.closest('dialog');
  // an open dialog closes itself; the focus stays in a dialog for a moment after it has closed
  if (dialog) return dialog.open;
  if (key === 'Escape') return false;
  return (
    target.closest(key === ' ' ? 'input, select, textarea, button, summary' : 'input, select, textarea') !==
    null
  );
}
