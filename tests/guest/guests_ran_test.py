#!/usr/bin/env python3
"""guests_ran.py names the guests' tests that were skipped, and no others."""
from guests_ran import not_run

RESULTS = """<testsuite>
  <testcase name="guest.kill" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/></testcase>
  <testcase name="guest_rt.timing" status="notrun"><skipped message=""/></testcase>
  <testcase name="guest.terminate" status="run"/>
  <testcase name="attribution.stop" status="notrun"><skipped message=""/></testcase>
</testsuite>"""


def main():
    assert not_run(RESULTS) == (["guest.kill", "guest_rt.timing"], 4), not_run(RESULTS)
    assert not_run("<testsuite/>") == ([], 0)
    print("guests_ran: done")


if __name__ == "__main__":
    main()
