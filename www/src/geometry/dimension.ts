/** 3D or 2D. */
export type Dimension = 2 | 3;
