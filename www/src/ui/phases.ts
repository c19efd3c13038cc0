/**
 * One colour a phase, the same in every chart: Okabe and Ito's, which stay apart with colour blindness. The phases of the
 * paper's Figure 7 come first.
 */
const COLORS: Record<string, string> = {
  sort: '#0072b2',
  insert: '#56b4e9',
  flip: '#009e73',
  relocate: '#e69f00',
  splay: '#d55e00',
  certify: '#cc79a7',
};

const OTHER = '#8b8f98';

export const phaseColor = (name: string): string => COLORS[name] ?? OTHER;
