"""Train a network with Stable-Baselines3 on the hall of this folder, and export it for MintPilot.

python train.py [--steps 200000] [--seed 0] [--out dqn.npz]

Needs mintpilot, gymnasium and stable-baselines3 (with torch; its CPU build is enough) in an environment of its own.
MintPilot itself needs none of these: it runs the exported weights in numpy.
"""

import argparse
from pathlib import Path

import gymnasium
import numpy as np
import torch
from stable_baselines3 import DQN
from stable_baselines3.common.env_util import make_vec_env

from mintpilot.assembly.learning import mission_grid
from mintpilot.core.policy import PolicyState, policy_task, step_lengths, steps
from mintpilot.policies.files import save_policy
from mintpilot.policies.grid import PolicyGrid
from mintpilot.policies.network import NetworkPolicy, observation, observation_size

HERE = Path(__file__).parent
EDGES_PER_UNIT = 10.0
"""Rewards are minus the length of a move, in tens of cell edges: networks learn small numbers better."""
BUMP = 2.0
"""Edges that a move into matter or smoke costs; the drone stays where it is."""
LONGEST = 80
"""Moves in one episode."""


class Hall(gymnasium.Env):
    """One flight: a cell and a joint hypothesis are drawn; it ends at a goal."""

    def __init__(self, grid: PolicyGrid) -> None:
        self.grid = grid
        self.tasks = [[policy_task(grid.under(mask), goal) for goal in grid.goals] for mask in range(grid.masks)]
        self.observation_space = gymnasium.spaces.Box(-1.0, 1.0, (observation_size(grid),), np.float32)
        self.action_space = gymnasium.spaces.Discrete(len(steps(grid.free.shape)))
        self.moves, self.lengths = steps(grid.free.shape), step_lengths(grid.free.shape)

    def reset(self, *, seed=None, options=None):
        """Draws a joint hypothesis, a goal and a free cell."""
        super().reset(seed=seed, options=options)
        self.mask = int(self.np_random.integers(self.grid.masks))
        self.goal = int(self.np_random.integers(len(self.grid.goals)))
        self.task, self.taken = self.tasks[self.mask][self.goal], 0
        free = np.argwhere(self.task.free)
        self.cell = self.task.goal
        while self.cell == self.task.goal:
            self.cell = tuple(int(i) for i in free[self.np_random.integers(len(free))])
        return observation(self.grid, self.mask, self.goal, self.cell), {}

    def step(self, action):
        """Moves, or bumps into what is not free."""
        cost = BUMP
        if self.task.allowed[self.cell][action]:
            cost = self.lengths[action]
            self.cell = tuple(int(i) for i in np.add(self.cell, self.moves[action]))
        self.taken += 1
        seen = observation(self.grid, self.mask, self.goal, self.cell)
        return seen, -cost / EDGES_PER_UNIT, self.cell == self.task.goal, self.taken >= LONGEST, {}


def exported(model: DQN, grid: PolicyGrid) -> NetworkPolicy:
    """The model's Q-network as numpy arrays; checked against torch on every cell."""
    linear = [m for m in model.q_net.q_net if isinstance(m, torch.nn.Linear)]
    layers = tuple((m.weight.detach().numpy().copy(), m.bias.detach().numpy().copy()) for m in linear)
    policy = NetworkPolicy(grid, layers, edges_per_unit=EDGES_PER_UNIT)
    for mask in range(grid.masks):
        for goal, place in enumerate(grid.goals):
            task = policy_task(grid.under(mask), place)
            for cell in np.argwhere(task.free):
                here = tuple(int(i) for i in cell)
                seen = torch.from_numpy(observation(grid, mask, goal, here))[None]
                theirs = model.q_net(seen)[0].detach().numpy() * EDGES_PER_UNIT
                ours = policy.q_values(PolicyState(task=task, cell=here))
                assert np.allclose(ours, theirs, atol=1e-3), f"cell {here}: {ours} here, {theirs} in torch"
    return policy


def main() -> None:
    """Trains, exports, checks the export."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=200_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=HERE / "dqn.npz")
    options = parser.parse_args()
    torch.set_num_threads(1)
    grid = mission_grid(HERE / "mission.yaml")
    model = DQN(
        "MlpPolicy",
        make_vec_env(lambda: Hall(grid), n_envs=8, seed=options.seed),
        learning_rate=1e-3,
        buffer_size=100_000,
        learning_starts=5_000,
        batch_size=128,
        gamma=1.0,
        train_freq=1,
        gradient_steps=2,
        target_update_interval=2_000,
        exploration_fraction=0.5,
        exploration_final_eps=0.1,
        policy_kwargs={"net_arch": [64, 64]},
        seed=options.seed,
        device="cpu",
    )
    model.learn(options.steps, log_interval=None)
    policy = exported(model, grid)
    save_policy(options.out, policy)
    print(
        f"{options.out}: {options.out.stat().st_size} bytes, {sum(w.size + b.size for w, b in policy.layers)} weights"
    )


if __name__ == "__main__":
    main()
