"""A fit or a plan as a notebook shows it."""

import base64
import html


def html_of(fit):
    """The verdict, the parameters and the report's page on request, light or dark as the notebook's page is."""
    color = {"pass": "#1a7f37", "warn": "#9a6700", "fail": "#cf222e"}
    worst = "fail" if not fit.trusted else "warn" if any(c.verdict == "warn" for c in fit.checks) else "pass"
    word = {"pass": "trusted", "warn": "trusted, with warnings", "fail": "not trusted"}[worst]
    out = [f'<div style="border-left:4px solid {color[worst]};padding:0 1em">'
           f"<p><b>{html.escape(fit.results['title'])}</b>: {word}</p>"]
    out += [f"<p>{html.escape(f'{c.name}: {c.detail}. {c.advice}'.rstrip())}</p>"
            for c in fit.checks if c.verdict != "pass"]
    posterior = "sampler" in fit.results
    if posterior:
        shown = fit.parameters[["unit", "mean", "sd", "q05", "q50", "q95"]]
        out.append(shown.to_html(float_format=lambda x: f"{x:.4g}", border=0))
    if posterior and len(fit.lives):
        out.append(fit.lives[["name", "of", "at", "unit", "q05", "q50", "q95", "b10"]].to_html(
            float_format=lambda x: f"{x:.4g}", border=0, index=False))
    out.append("</div>")
    if "report.json" in fit._files():
        out.append(_page_on_request(fit._html()))
    return "".join(out)


def html_of_plan(title, text, page):
    """What the program prints, and the report's page on request."""
    return f"<p><b>{html.escape(title)}</b></p><pre>{html.escape(text)}</pre>{_page_on_request(page)}"


def _page_on_request(page):
    page = base64.b64encode(page.encode()).decode()
    return ('<details><summary>The report</summary><iframe style="width:100%;height:40em;border:0" '
            f'sandbox="allow-scripts" src="data:text/html;charset=utf-8;base64,{page}"></iframe></details>')
