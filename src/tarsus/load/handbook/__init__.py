"""Source 004's hand calculation of joint torques, line by line, and its comparison with statics."""
