# SPDX-License-Identifier: BSD-3-Clause
import pytest


@pytest.fixture(scope="session")
def scenario():
    """The small shelf."""
    from built import SHELF, tactus
    with tactus.Scenario.load(SHELF) as loaded:
        yield loaded
