//! Agents: environment, replay buffer, networks, DDPG, trainer.
