import { defaultKeymap, history, historyKeymap } from '@codemirror/commands';
import { javascript } from '@codemirror/lang-javascript';
import { bracketMatching, HighlightStyle, syntaxHighlighting } from '@codemirror/language';
import { EditorState, StateEffect, StateField } from '@codemirror/state';
import {
  Decoration,
  type DecorationSet,
  drawSelection,
  EditorView,
  highlightSpecialChars,
  keymap,
  lineNumbers,
} from '@codemirror/view';
import { tags } from '@lezer/highlight';

/** The colours are those of the page, which change with its theme. */
const colors = HighlightStyle.define([
  { tag: [tags.comment], color: 'var(--code-comment)', fontStyle: 'italic' },
  { tag: [tags.keyword, tags.operatorKeyword, tags.modifier], color: 'var(--code-keyword)' },
  { tag: [tags.string, tags.special(tags.string), tags.regexp], color: 'var(--code-string)' },
  { tag: [tags.number, tags.bool, tags.null], color: 'var(--code-number)' },
  {
    tag: [tags.function(tags.variableName), tags.function(tags.propertyName)],
    color: 'var(--code-call)',
  },
]);

const markLine = StateEffect.define<number | null>();

/** The line that an error names. */
const marked = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(shown, { effects, docChanged, state: { doc } }) {
    for (const effect of effects) {
      if (!effect.is(markLine)) continue;
      if (effect.value === null || effect.value > doc.lines) return Decoration.none;
      const line = Decoration.line({ class: 'wrong' });
      return Decoration.set(line.range(doc.line(effect.value).from));
    }
    return docChanged ? Decoration.none : shown;
  },
  provide: (field) => EditorView.decorations.from(field),
});

export interface Editor {
  readonly text: string;
  /** Replaces the whole text. */
  put(text: string): void;
  /** Marks a line, counted from 1, or none. */
  mark(line: number | null): void;
}

/** Puts an editor into a place. Tab leaves it, as on the rest of the page. */
export function editorIn(
  place: HTMLElement,
  text: string,
  { readOnly, changed, run }: { readOnly: boolean; changed: () => void; run: () => void },
): Editor {
  const view = new EditorView({
    parent: place,
    state: EditorState.create({
      doc: text,
      extensions: [
        lineNumbers(),
        EditorState.readOnly.of(readOnly),
        EditorView.editable.of(!readOnly),
        highlightSpecialChars(),
        history(),
        drawSelection(),
        bracketMatching(),
        javascript(),
        syntaxHighlighting(colors),
        marked,
        // What cannot be changed can be scrolled by keys all the same.
        EditorView.contentAttributes.of({ 'aria-label': 'The code of the example', tabindex: '0' }),
        EditorView.updateListener.of(({ docChanged }) => docChanged && changed()),
        keymap.of([
          { key: 'Ctrl-Enter', mac: 'Cmd-Enter', run: () => run() ?? true },
          ...defaultKeymap,
          ...historyKeymap,
        ]),
      ],
    }),
  });
  return {
    get text() {
      return view.state.doc.toString();
    },
    put(text) {
      view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text } });
    },
    mark(line) {
      view.dispatch({ effects: markLine.of(line) });
    },
  };
}
