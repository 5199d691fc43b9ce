"""What ``hystrip audit`` has the solver measure and draw for its pages; their text comes from the derivation alone."""
