"""Actuators: what an actuated channel does with what it is asked. Depends on nothing.

asked → dead band → rate limit → first-order lag → done. A channel without lag and rate limit has no state.

Notes
-----
ẏ = clip((u − y)/τ, −R, R): within the rate limit a first-order lag of time constant τ, beyond it a ramp of slope R.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

QUICK = 0.02
"""Time constant [s] with which a channel follows that has a rate limit and no lag of its own."""


class Actuators(eqx.Module):
    """A group of actuated channels of one kind: thrusters, or control surfaces.

    Attributes
    ----------
    lag : Float[Array, "slow"]
        Time constant τ of each channel that has a state [s].
    rate_limit : Float[Array, "slow"]
        Fastest change R of each of them [channel's unit per second]; inf for none.
    dead_band : Float[Array, "banded"]
        What is asked of a channel with a dead band is zero below this [channel's unit].
    slow, banded : tuple of int
        Places of these channels in the group.
    """

    lag: Float[Array, "slow"]
    rate_limit: Float[Array, "slow"]
    dead_band: Float[Array, "banded"]
    slow: tuple[int, ...] = eqx.field(static=True)
    banded: tuple[int, ...] = eqx.field(static=True)

    @classmethod
    def ideal(cls) -> "Actuators":
        """Return a group that does at once what it is asked."""
        none = jnp.zeros(0)
        return cls(none, none, none, (), ())

    def effective(self, asked: Float[Array, "channels"]) -> Float[Array, "channels"]:
        """Return what is asked with the dead band applied [channel's unit]: zero within it, unchanged outside."""
        if not self.banded:
            return asked
        places = jnp.asarray(self.banded)
        through = jnp.where(jnp.abs(asked[places]) < self.dead_band, 0.0, asked[places])
        return asked.at[places].set(through)

    def rest(self, asked: Float[Array, "channels"]) -> Float[Array, "slow"]:
        """Return the states at which nothing changes any more [channel's unit]."""
        return self.effective(asked)[jnp.asarray(self.slow)] if self.slow else jnp.zeros(0)

    def output(self, own: Float[Array, "slow"], asked: Float[Array, "channels"]) -> Float[Array, "channels"]:
        """Return what the channels do [their unit]; those without a state do what is asked."""
        effective = self.effective(asked)
        return effective.at[jnp.asarray(self.slow)].set(own) if self.slow else effective

    def rate(self, own: Float[Array, "slow"], asked: Float[Array, "channels"]) -> Float[Array, "slow"]:
        """Return the rates of the states [channel's unit per second]."""
        return jnp.clip((self.rest(asked) - own) / self.lag, -self.rate_limit, self.rate_limit)
