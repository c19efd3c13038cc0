// The signs of triangles whose points have moved.
//!include d2/signs
