//! Recommendations: the policy's shot, checked by simulation, then search.
