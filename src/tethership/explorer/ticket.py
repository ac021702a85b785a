"""Who may come in: the browser or script that was given this run's secret. Depends on nothing of tethership.

Loopback is shared by all users of a machine, so an address alone keeps nobody out. The secret stands in the address
that is printed; whoever opens that gets a cookie, and the secret leaves the address line.
"""

import hmac
import secrets

PARAMETER = "token"
"""Name of the secret in the address."""


class Ticket:
    """The secrets of one run.

    Parameters
    ----------
    port : int
        Where it is served: a browser keeps one cookie of a name for all ports of a machine.
    """

    def __init__(self, port: int) -> None:
        self.token = secrets.token_urlsafe(32)
        self.cookie_name = f"tethership-{port}"
        self.cookie_value = secrets.token_urlsafe(32)

    @property
    def cookie(self) -> str:
        """The cookie as a request's header has it."""
        return f"{self.cookie_name}={self.cookie_value}"

    def opens(self, token: str | None) -> bool:
        """Return whether this is the secret of the address."""
        return _same(token, self.token)

    def admits(self, value: str | None) -> bool:
        """Return whether this is the value of the cookie."""
        return _same(value, self.cookie_value)


def _same(given: str | None, secret: str) -> bool:
    """Return whether two texts are the same, in a time that does not tell where they differ."""
    return given is not None and hmac.compare_digest(given.encode(errors="replace"), secret.encode())
