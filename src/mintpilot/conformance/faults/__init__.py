"""The fault campaign: faults into running missions, judged by monitors that share no code with what they judge."""
