"""What reports say, in a real browser: their data, answers, tables and layout, extreme ones, what was untangled, and pages
of many jobs."""
import answer_scenarios
import changes_scenarios
import data_scenarios
import extremes_scenarios
import jobs_scenarios
import layout_scenarios
import tables_scenarios
import untangled_scenarios
from browser import context, play, scenarios_of  # noqa: F401


@scenarios_of(data_scenarios, answer_scenarios, changes_scenarios, tables_scenarios, layout_scenarios, extremes_scenarios,
              jobs_scenarios, untangled_scenarios)
def test_scenario(scenario, context, capsys):  # noqa: F811
    play(scenario, context, capsys)
