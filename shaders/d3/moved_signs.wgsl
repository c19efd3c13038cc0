// The signs of tetrahedra whose points have moved.
//!include d3/signs
