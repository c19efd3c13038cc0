/** What another library made of the points. */
export interface OtherResult {
  milliseconds: number;
  simplices: number;
  /** Those of volume or area zero, by exact arithmetic. */
  flat: number;
}
