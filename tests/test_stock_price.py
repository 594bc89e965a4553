"""What parts from stock cost: the page is made from its figures, and these are those of runs."""

import pytest
import stock_price
import yaml
from support import study_path

from tvimdesign.study import read_study_text


def test_the_page_holds_the_tables_of_the_figures() -> None:
    page = stock_price.PAGE.read_text(encoding="utf-8")
    tables = list(stock_price.tables(stock_price.read_figures()))
    assert tables
    assert all(table in page for table in tables)


def test_each_step_is_a_study_and_the_last_is_the_shipped_one() -> None:
    for case, about in stock_price.cases().items():
        for index in range(len(about["steps"])):
            read_study_text(yaml.safe_dump(stock_price.study_of(case, index), allow_unicode=True), case)
        shipped = yaml.safe_load(study_path(case).read_text(encoding="utf-8"))
        assert stock_price.study_of(case, len(about["steps"]) - 1) == shipped


@pytest.mark.slow
def test_the_figures_are_those_of_runs() -> None:
    figures = stock_price.read_figures()
    for case, about in stock_price.cases().items():
        for index in (0, len(about["steps"]) - 1):
            step = about["steps"][index]["name"]
            if (case, step) not in figures:
                continue  # no figures yet; the page has no table of it either
            found = stock_price.run(stock_price.study_of(case, index))
            known = {name: figures[case, step][name] for name in stock_price.OUTPUTS}
            assert {name: found[name] for name in stock_price.OUTPUTS} == pytest.approx(known, rel=0.02), (case, step)
