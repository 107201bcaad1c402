"""Worlds to fly in: scenes, scenarios, the kinematic and the MuJoCo simulator."""
