"""A vehicle double: an autopilot that speaks MAVLink over UDP, in PX4's and in ArduPilot's way, with faults by switch.

It is no simulator of a firmware: it sends and answers what those firmwares were seen to, and does what they do when
nobody is heard any more, so that the whole way from a mission to an autopilot can be tried on one machine.
"""
