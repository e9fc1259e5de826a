# The report's figures (Vega-Lite, as src/wearwell/present/plot.h makes them) as plain layers, drawn by base graphics or ggplot2.

figure_kinds <- list(
  life = "^(life|life-stress-.*|remaining-lives|lives|hazard)$",
  probability = "^(probability-paper|failure-probability)$",
  curve = "^(sn-curve|history|path-.*|life-stress-.*|design-curves|haigh|chart|failure-probability)$",
  posterior = "^belief-",
  residuals = "^check$")

# All figures of the report, by id: title, caption, specification.
figures_of <- function(fit) {
  files <- files_of(fit)
  if (is.na(files["report.json"])) stop_input("this fit was made with report = FALSE; fit it again with report = TRUE for its pictures")
  blocks <- unlist(lapply(core(C_from_json, files[["report.json"]])$sections, `[[`, "blocks"), recursive = FALSE)
  figures <- unlist(lapply(blocks, function(block) block$figures), recursive = FALSE)
  stats::setNames(figures, vapply(figures, `[[`, "", "id"))
}

# The figures of a kind, or of an id.
chosen_figures <- function(fit, kind) {
  if (!is_path(kind)) stop_input("kind is ", shown_value(kind), "; it is one of ", words(names(figure_kinds)), ", or the name of a figure")
  figures <- figures_of(fit)
  if (kind %in% names(figures)) {
    if (!kind %in% names(figure_kinds)) return(figures[kind])
  } else if (!kind %in% names(figure_kinds)) {
    stop_input("kind is ", shown_value(kind), "; it is one of ", words(names(figure_kinds)), ", or a figure of this fit: ", words(names(figures)))
  }
  found <- figures[grepl(figure_kinds[[kind]], names(figures))]
  if (!length(found)) {
    stop_input("this fit has no figure of the kind '", kind, "'; it has ", words(setdiff(names(figures), grep("^(trace|chains|draws)-", names(figures), value = TRUE))))
  }
  found
}

# ---- A specification as an axis and layers.

axis_of_figure <- function(layers, channel) {
  encodings <- Filter(Negate(is.null), lapply(layers, function(layer) layer[["encoding"]][[channel]]))
  encodings <- Filter(function(each) !is.null(each[["scale"]]), encodings)
  if (!length(encodings)) return(list(title = "", log = FALSE))
  each <- encodings[[1]]
  scale <- each[["scale"]]
  low <- if (!is.null(scale[["domain"]])) scale[["domain"]][1] else scale[["domainMin"]]
  high <- if (!is.null(scale[["domain"]])) scale[["domain"]][2] else scale[["domainMax"]]
  at <- each[["axis"]][["values"]]
  list(title = each[["title"]], log = identical(scale[["type"]], "log"), low = low, high = high, hidden = identical(each[["axis"]][["labels"]], FALSE),
       at = at, labels = if (!is.null(at)) tick_labels(each[["axis"]][["labelExpr"]], at))
}

# Names of ticks: ["a","b"][datum.value - 1], or abs(datum.value-(x))<1e-9?"name":...
tick_labels <- function(expression, at) {
  if (is.null(expression)) return(number_text(at))
  if (startsWith(expression, "[")) return(core(C_from_json, sub("\\[datum[.]value - 1\\]$", "", expression))[at])
  pairs <- regmatches(expression, gregexpr("abs\\(datum[.]value-\\(([^)]*)\\)\\)<1e-9[?](\"[^\"]*\")", expression))[[1]]
  parts <- regmatches(pairs, regexec("abs\\(datum[.]value-\\(([^)]*)\\)\\)<1e-9[?](\"[^\"]*\")", pairs))
  places <- as.double(vapply(parts, `[`, "", 2))
  names <- vapply(parts, function(each) core(C_from_json, paste0("[", each[3], "]")), "")
  vapply(at, function(x) {
    near <- which.min(abs(places - x))
    if (length(near) && abs(places[near] - x) < 1e-6) names[near] else ""
  }, "")
}

layer_of_figure <- function(layer) {
  values <- layer[["data"]][["values"]]
  if (!is_path(values)) return(NULL)  # a message instead of marks
  mark <- layer[["mark"]]
  label <- layer[["encoding"]][["color"]]$datum
  colour <- mark[["stroke"]]
  if (is.null(colour)) colour <- mark[["fill"]]
  if (is.null(colour)) colour <- mark[["color"]]
  if (!is.null(label)) {
    scale <- layer[["encoding"]][["color"]]$scale
    colour <- scale[["range"]][match(label, scale[["domain"]])]
  }
  data <- read.csv(text = values, check.names = FALSE)
  list(type = mark[["type"]], data = data, label = label, colour = if (is.null(colour)) "#8a8f98" else colour,
       opacity = if (is.null(mark[["opacity"]])) 1 else mark[["opacity"]], width = if (is.null(mark[["strokeWidth"]])) 2 else mark[["strokeWidth"]],
       dashed = !is.null(mark[["strokeDash"]]), steps = identical(mark[["interpolate"]], "step-after"), shape = mark[["shape"]],
       size = if (is.null(mark[["size"]])) 50 else mark[["size"]], text = mark[["text"]], has_x = !is.null(layer[["encoding"]][["x"]]), has_y = !is.null(layer[["encoding"]][["y"]]))
}

drawing_of <- function(figure) {
  specification <- figure$specification
  all <- if (is.null(specification$layer)) list(specification) else specification$layer
  layers <- Filter(Negate(is.null), lapply(all, layer_of_figure))
  if (!length(layers)) stop_input("the figure '", figure$id, "' has nothing to draw")
  list(title = figure$title, caption = figure$caption, x = axis_of_figure(all, "x"), y = axis_of_figure(all, "y"), layers = layers)
}

range_of <- function(axis, layers, channel) {
  values <- unlist(lapply(layers, function(layer) layer$data[intersect(c(channel, paste0(channel, "2")), names(layer$data))]))
  if (channel == "y" && any(vapply(layers, function(layer) layer$type == "area" && is.null(layer$data$y2), NA))) values <- c(values, 0)
  values <- values[is.finite(values) & (!axis$log | values > 0)]
  ends <- range(values)
  if (!is.null(axis$low)) ends[1] <- axis$low
  if (!is.null(axis$high)) ends[2] <- axis$high
  if (ends[1] == ends[2]) ends <- ends + c(-0.5, 0.5) * max(abs(ends[1]), 1) * if (axis$log) 0.1 else 1
  ends
}

# ---- Base graphics.

faded <- function(colour, opacity) grDevices::adjustcolor(colour, alpha.f = opacity)

point_shape <- function(shape, filled = TRUE) {
  if (is.null(shape)) return(19)
  switch(shape, `triangle-up` = 17, `triangle-right` = 2, `triangle-left` = 6, square = 15, 19)
}

draw_area <- function(layer) {
  data <- layer$data
  if (!is.null(data$x2)) {
    graphics::polygon(c(data$x, rev(data$x2)), c(data$y, rev(data$y)), col = faded(layer$colour, layer$opacity), border = NA)
    return()
  }
  floor <- if (is.null(data$y2)) rep(0, nrow(data)) else data$y2
  keep <- is.finite(data$x) & is.finite(data$y) & is.finite(floor)
  bottom <- graphics::par("usr")[3]
  if (graphics::par("ylog")) {
    floor <- pmax(floor, 10^bottom)
    data$y <- pmax(data$y, 10^bottom)
  }
  graphics::polygon(c(data$x[keep], rev(data$x[keep])), c(data$y[keep], rev(floor[keep])), col = faded(layer$colour, layer$opacity), border = NA)
}

draw_rule <- function(layer) {
  data <- layer$data
  colour <- faded(layer$colour, layer$opacity)
  line <- if (layer$dashed) 2 else 1
  width <- layer$width * 0.75
  if (!layer$has_y) return(graphics::abline(v = data$x, col = colour, lty = line, lwd = width))
  if (!layer$has_x) return(graphics::abline(h = data$y, col = colour, lty = line, lwd = width))
  x2 <- if (is.null(data$x2)) data$x else data$x2
  y2 <- if (is.null(data$y2)) data$y else data$y2
  graphics::segments(data$x, data$y, x2, y2, col = colour, lty = line, lwd = width, lend = 1)
}

draw_layer <- function(layer) {
  data <- layer$data
  colour <- faded(layer$colour, layer$opacity)
  switch(layer$type,
    area = draw_area(layer),
    rule = draw_rule(layer),
    line = graphics::lines(data$x, data$y, col = colour, lty = if (layer$dashed) 2 else 1, lwd = layer$width * 0.75, type = if (layer$steps) "s" else "l"),
    point = graphics::points(data$x, data$y, col = colour, pch = point_shape(layer$shape), cex = sqrt(layer$size / 60)),
    rect = graphics::rect(data$x, data$y, data$x2, data$y2, border = NA,
                          col = if (is.null(data$density)) colour else vapply(pmin(1, pmax(0, shade_of(data$density))), function(a) faded(layer$colour, a), "")),
    text = graphics::text(data$x, data$y, layer$text, col = colour, pos = 2, cex = 0.8),
    stop_input("a figure has a mark that is not drawn: ", layer$type))
}

shade_of <- function(density) if (max(density, na.rm = TRUE) > 1) density / max(density, na.rm = TRUE) else density

legend_of_figure <- function(drawing) {
  labelled <- Filter(function(layer) !is.null(layer$label), drawing$layers)
  labelled <- labelled[!duplicated(vapply(labelled, `[[`, "", "label"))]
  if (!length(labelled)) return()
  is_line <- vapply(labelled, function(layer) layer$type %in% c("line", "rule") && layer$width < 5, NA)
  is_point <- vapply(labelled, function(layer) layer$type == "point", NA)
  graphics::legend("topleft", vapply(labelled, `[[`, "", "label"), bty = "n", cex = 0.8, inset = c(0, -0.005),
                   col = vapply(labelled, function(layer) faded(layer$colour, layer$opacity), ""),
                   lty = ifelse(is_line, ifelse(vapply(labelled, `[[`, NA, "dashed"), 2, 1), NA), lwd = 2,
                   pch = ifelse(is_point, vapply(labelled, function(layer) point_shape(layer$shape), 0), ifelse(is_line, NA, 15)))
}

draw_figure <- function(drawing) {
  logs <- paste0(if (drawing$x$log) "x" else "", if (drawing$y$log) "y" else "")
  graphics::plot.default(NA, xlim = range_of(drawing$x, drawing$layers, "x"), ylim = range_of(drawing$y, drawing$layers, "y"), log = logs,
                         xlab = drawing$x$title, ylab = drawing$y$title, axes = FALSE, main = drawing$title, cex.main = 1)
  for (layer in drawing$layers) draw_layer(layer)
  for (side in 1:2) {
    axis <- if (side == 1) drawing$x else drawing$y
    if (isTRUE(axis$hidden)) next
    if (is.null(axis$at)) graphics::axis(side) else graphics::axis(side, at = axis$at, labels = axis$labels, las = if (side == 2) 1 else 0)
  }
  graphics::box(col = "grey70")
  legend_of_figure(drawing)
}

# Residuals against standard normal quantiles, where the report has no figure of them.
residual_drawing <- function(fit) {
  found <- residuals(fit)
  order <- order(found)
  z <- stats::qnorm(stats::ppoints(length(found)))
  censored <- attr(found, "censored")[order]
  points <- data.frame(x = z, y = as.vector(found)[order])
  layer <- function(...) utils::modifyList(list(opacity = 1, width = 2, dashed = FALSE, steps = FALSE, size = 50, has_x = TRUE, has_y = TRUE), list(...))
  ends <- range(z)
  layers <- list(layer(type = "line", data = data.frame(x = ends, y = ends), colour = "#8a8f98", label = "standard normal"),
                 layer(type = "point", data = points[!censored, ], colour = "#e0592a", label = "observations"))
  if (any(censored)) layers <- c(layers, list(layer(type = "point", data = points[censored, ], colour = "#2f7fd6", label = "censored", shape = "triangle-up")))
  list(title = "Quantile residuals", caption = "", x = list(title = "Standard normal quantile", log = FALSE), y = list(title = "Residual", log = FALSE),
       layers = Filter(function(each) nrow(each$data) > 0, layers))
}

drawings_of <- function(fit, kind) {
  if (identical(kind, "residuals")) {
    figures <- if (isTRUE(fit$report)) figures_of(fit)
    if (!any(grepl(figure_kinds$residuals, names(figures)))) return(list(residual_drawing(fit)))
  }
  lapply(unname(chosen_figures(fit, kind)), drawing_of)
}

plot.ww_fit <- function(x, kind = "posterior", which = NULL, breaks = 40, ...) {
  if (identical(kind, "posterior") && (!isTRUE(x$report) || !is.null(which))) return(plot_draws(x, which, breaks, ...))
  if (!is.null(which)) stop_input("which names parameters, and goes with kind = \"posterior\"")
  drawings <- drawings_of(x, kind)
  if (kind != "posterior" && length(drawings) > 4) drawings <- drawings[1:4]
  across <- ceiling(sqrt(length(drawings)))
  if (length(drawings) > 1) {
    old <- par(mfrow = c(ceiling(length(drawings) / across), across), mar = c(4, 4, 2, 1), oma = c(0, 0, 2, 0))
  } else {
    old <- par(mar = c(4, 4, 4, 1), oma = c(0, 0, 1, 0))
  }
  on.exit(par(old))
  for (drawing in drawings) draw_figure(drawing)
  mtext(verdict_of(x), outer = TRUE, col = verdict_colour(x), font = 2, cex = 0.9)
  invisible(x)
}

verdict_colour <- function(x) if (!x$trusted) "#cf222e" else if (any(x$checks$verdict == "warn")) "#9a6700" else "#1a7f37"

# ---- ggplot2.

autoplot.ww_fit <- function(object, kind = "posterior", ...) {
  drawings <- drawings_of(object, kind)
  plots <- lapply(drawings, function(drawing) gg_figure(drawing, verdict_of(object)))
  if (length(plots) == 1) plots[[1]] else plots
}

gg_layer <- function(layer) {
  gg <- asNamespace("ggplot2")
  data <- layer$data
  aes <- function(...) gg$aes(...)
  colour <- if (is.null(layer$label)) NULL else layer$label
  line <- if (layer$dashed) 2 else 1
  fixed <- function(...) c(list(...), if (is.null(colour)) list(colour = layer$colour))
  data$.label <- if (is.null(colour)) rep("", nrow(data)) else rep(colour, nrow(data))
  .data <- gg$.data
  mapped <- function(mapping, fill = FALSE) {
    if (!is.null(colour)) mapping <- utils::modifyList(mapping, if (fill) aes(fill = .data$.label) else aes(colour = .data$.label))
    structure(mapping, class = "uneval")
  }
  call <- function(geom, mapping, ..., fill = FALSE) {
    paint <- if (is.null(colour)) stats::setNames(list(layer$colour), if (fill) "fill" else "colour")
    do.call(gg[[geom]], c(list(mapping = mapped(mapping, fill), data = data, alpha = layer$opacity, ...), paint))
  }
  switch(layer$type,
    area = {
      if (is.null(data$y2)) data$y2 <- 0
      if (is.null(data$x2)) call("geom_ribbon", aes(x = .data$x, ymin = .data$y2, ymax = .data$y), fill = TRUE) else
        call("geom_ribbon", aes(y = .data$y, xmin = .data$x2, xmax = .data$x), fill = TRUE)
    },
    rule = if (!layer$has_y) call("geom_vline", aes(xintercept = .data$x), linetype = line) else
      if (!layer$has_x) call("geom_hline", aes(yintercept = .data$y), linetype = line) else {
        if (is.null(data$x2)) data$x2 <- data$x
        if (is.null(data$y2)) data$y2 <- data$y
        call("geom_segment", aes(x = .data$x, y = .data$y, xend = .data$x2, yend = .data$y2), linetype = line, linewidth = layer$width / 3)
      },
    line = call(if (layer$steps) "geom_step" else "geom_path", aes(x = .data$x, y = .data$y), linetype = line, linewidth = layer$width / 3),
    point = call("geom_point", aes(x = .data$x, y = .data$y), shape = point_shape(layer$shape), size = sqrt(layer$size) / 4),
    rect = {
      data$.shade <- if (is.null(data$density)) 1 else pmin(1, pmax(0, shade_of(data$density)))
      gg$geom_rect(mapping = aes(xmin = .data$x, xmax = .data$x2, ymin = .data$y, ymax = .data$y2), data = data, fill = layer$colour,
                   alpha = data$.shade, colour = NA)
    },
    text = gg$geom_text(mapping = aes(x = .data$x, y = .data$y), data = data, label = layer$text, colour = layer$colour, hjust = 1.1, vjust = -0.4))
}

gg_figure <- function(drawing, verdict) {
  gg <- asNamespace("ggplot2")
  plot <- gg$ggplot()
  for (layer in drawing$layers) plot <- plot + gg_layer(layer)
  labelled <- Filter(function(layer) !is.null(layer$label), drawing$layers)
  colours <- vapply(labelled, `[[`, "", "colour")
  names(colours) <- vapply(labelled, `[[`, "", "label")
  colours <- colours[!duplicated(names(colours))]
  if (length(colours)) {
    plot <- plot + gg$scale_colour_manual(values = colours, name = NULL) + gg$scale_fill_manual(values = colours, name = NULL)
  }
  scale <- function(axis, channel) {
    arguments <- list(name = axis$title)
    if (isTRUE(axis$hidden)) arguments["breaks"] <- list(NULL)
    if (!is.null(axis$at)) arguments <- c(arguments, list(breaks = axis$at, labels = axis$labels))
    do.call(gg[[paste0("scale_", channel, if (axis$log) "_log10" else "_continuous")]], arguments)
  }
  plot + scale(drawing$x, "x") + scale(drawing$y, "y") +
    gg$coord_cartesian(xlim = range_of(drawing$x, drawing$layers, "x"), ylim = range_of(drawing$y, drawing$layers, "y")) +
    gg$labs(title = drawing$title, subtitle = verdict, caption = paste(strwrap(drawing$caption, 90), collapse = "\n")) + gg$theme_minimal()
}
